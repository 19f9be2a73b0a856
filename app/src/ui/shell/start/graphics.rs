//! The graphics interface that the window is drawn with, as the environment names it.

use std::ffi::OsStr;

/// Environment variable that chooses the graphics interface of wgpu.
pub const VARIABLE: &str = "WGPU_BACKEND";

/// Interfaces that a list like `vulkan, gl` names; `None` if it is empty, which is as unset.
pub fn chosen(list: &OsStr, here: wgpu::Backends) -> anyhow::Result<Option<wgpu::Backends>> {
    let list = list.to_string_lossy();
    let names: Vec<&str> = list.split(',').map(str::trim).filter(|name| !name.is_empty()).collect();
    if names.is_empty() {
        return Ok(None);
    }
    let mut chosen = wgpu::Backends::empty();
    for name in names {
        let named = named(name);
        anyhow::ensure!(
            !named.is_empty(),
            "`{name}` in {VARIABLE} is no graphics interface; write {}, or unset the variable",
            names_of(here)
        );
        chosen |= named;
    }
    anyhow::ensure!(
        chosen.intersects(here),
        "{VARIABLE} names an interface that this system does not have; write {}, or unset the variable",
        names_of(here)
    );
    Ok(Some(chosen & here))
}

/// All names of each interface, in the order of preference; wgpu reads the same ones.
const NAMES: [(&[&str], wgpu::Backends); 4] = [
    (&["vulkan", "vk"], wgpu::Backends::VULKAN),
    (&["dx12", "d3d12"], wgpu::Backends::DX12),
    (&["metal", "mtl"], wgpu::Backends::METAL),
    (&["gl", "gles", "opengl"], wgpu::Backends::GL),
];

fn named(name: &str) -> wgpu::Backends {
    let name = name.to_lowercase();
    NAMES.iter().find(|(names, _)| names.contains(&name.as_str())).map_or(wgpu::Backends::empty(), |(_, one)| *one)
}

/// Names that may be written here, as in `vulkan or gl`.
fn names_of(here: wgpu::Backends) -> String {
    let names: Vec<&str> =
        NAMES.iter().filter(|(_, one)| here.contains(*one)).filter_map(|(names, _)| names.first().copied()).collect();
    names.join(" or ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use wgpu::Backends;

    const HERE: Backends = Backends::VULKAN.union(Backends::GL);

    fn of(list: &str) -> Result<Option<Backends>, String> {
        chosen(OsStr::new(list), HERE).map_err(|error| error.to_string())
    }

    #[test]
    fn an_empty_list_is_as_unset() {
        for list in ["", " ", ",", " , "] {
            assert_eq!(of(list), Ok(None), "{list:?}");
        }
    }

    #[test]
    fn all_names_of_an_interface_are_known_in_any_case() {
        assert_eq!(of("VK"), Ok(Some(Backends::VULKAN)));
        assert_eq!(of("OpenGL"), Ok(Some(Backends::GL)));
        assert_eq!(of(" gl , vulkan,"), Ok(Some(HERE)));
        // Another system's interface beside one of this system is passed over.
        assert_eq!(of("dx12,vulkan"), Ok(Some(Backends::VULKAN)));
    }

    #[test]
    fn a_name_that_is_none_is_refused_with_the_names_that_are() {
        for list in ["vulcan", "gl,vulcan"] {
            let said = "`vulcan` in WGPU_BACKEND is no graphics interface; write vulkan or gl, or unset the variable";
            assert_eq!(of(list), Err(said.to_owned()), "{list}");
        }
        assert!(of("metal").is_err_and(|said| said.contains("WGPU_BACKEND") && said.contains("vulkan or gl")));
    }
}
