//! Settings of a remote device before its port is opened: the validated fields of the Devices page.

use haptics::device::channel::Waves;
use haptics::device::udp::{Key, PORT, UdpConfig};
use haptics::servo::rate::SAFE_HZ;
use haptics::world::World;
use std::net::{Ipv4Addr, SocketAddr};
use std::path::Path;

/// Maximum round-trip time, ms.
const MOST_ROUND_TRIP_MS: f64 = 5000.0;
/// Maximum damping that a device may state, N s/m.
const MOST_DAMPING_N_S_M: f64 = 1000.0;

/// Fields as typed. Empty ones mean the default: this machine only, nothing stated.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Remote {
    /// File with the shared key.
    pub key: String,
    /// Local address to listen on, with or without a port.
    pub address: String,
    /// The device's own damping, N s/m.
    pub damping: String,
    /// Time from here to the device and back, ms.
    pub round_trip: String,
    /// True if the packets carry wave variables in place of positions and forces.
    pub waves: bool,
}

impl Remote {
    /// Device configuration; the error is one sentence about the invalid field.
    pub fn config(&self, world: &World) -> Result<UdpConfig, String> {
        let path = self.key.trim();
        if path.is_empty() {
            return Err("A remote device needs a key: name a file with 64 hexadecimal digits.".to_owned());
        }
        // Typed values are checked before the key is read from the disk.
        let listen = listen(self.address.trim())?;
        let damping_n_s_m = figure(&self.damping, MOST_DAMPING_N_S_M, "damping", "N s/m, like 0.5")?;
        let round_trip_ms = figure(&self.round_trip, MOST_ROUND_TRIP_MS, "round trip", "ms, like 12")?;
        let key = Key::load(Path::new(path)).map_err(|e| crate::text::sentence::sentence(&e.to_string()))?;
        let mut config = UdpConfig::loopback(key);
        config.listen = listen;
        config.spec.damping_n_s_m = damping_n_s_m;
        config.delay_s = 1e-3 * round_trip_ms;
        // For the slowest rate: a damper that is sufficient there is sufficient at every faster one.
        config.waves = self.waves.then(|| Waves::new(&config.spec, world, 1.0 / SAFE_HZ));
        Ok(config)
    }

    /// Problem of the fields other than the key, for a line below them; `None` if they are valid.
    pub fn problem(&self) -> Option<String> {
        let listen = listen(self.address.trim()).map(drop);
        let damping = figure(&self.damping, MOST_DAMPING_N_S_M, "damping", "N s/m, like 0.5").map(drop);
        let round_trip = figure(&self.round_trip, MOST_ROUND_TRIP_MS, "round trip", "ms, like 12").map(drop);
        listen.and(damping).and(round_trip).err()
    }
}

/// Address to listen on; an empty text is this machine at the default port.
pub fn listen(address: &str) -> Result<SocketAddr, String> {
    if address.is_empty() {
        return Ok(SocketAddr::from((Ipv4Addr::LOCALHOST, PORT)));
    }
    let with_port = address.parse::<SocketAddr>().ok();
    with_port.or_else(|| address.parse().ok().map(|ip| SocketAddr::new(ip, PORT))).ok_or_else(|| {
        format!("`{address}` is no address of this machine; write 127.0.0.1:{PORT}, or that of a network card.")
    })
}

/// Number from 0 to `most`; an empty text is 0.
pub fn figure(text: &str, most: f64, what: &str, how: &str) -> Result<f64, String> {
    let text = text.trim();
    if text.is_empty() {
        return Ok(0.0);
    }
    let value = text.parse().ok().filter(|value| (0.0..=most).contains(value));
    value.ok_or_else(|| format!("`{text}` is no {what}: write a number from 0 to {most} in {how}."))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write as _;

    fn remote(address: &str, damping: &str, round_trip: &str) -> Remote {
        let key = "/nowhere/key".to_owned();
        Remote { key, address: address.into(), damping: damping.into(), round_trip: round_trip.into(), waves: false }
    }

    #[test]
    fn fields_are_read_or_the_wrong_one_is_named() {
        let mut file = tempfile::NamedTempFile::new().expect("a file");
        writeln!(file, "{}", "5a".repeat(32)).expect("written");
        let key = file.path().display().to_string();
        let config = Remote { key: key.clone(), ..remote(" 127.0.0.1:9 ", "0.4", " 12 ") }
            .config(&World::empty("x"))
            .expect("all right");
        assert_eq!(config.listen.to_string(), "127.0.0.1:9");
        assert_eq!((config.spec.damping_n_s_m, config.delay_s), (0.4, 0.012));
        assert!(config.waves.is_none());
        let waving = Remote { key: key.clone(), waves: true, ..Remote::default() };
        assert!(waving.config(&World::empty("x")).is_ok_and(|config| config.waves.is_some()));
        let usual = Remote { key, ..Remote::default() }.config(&World::empty("x")).expect("the usual");
        assert_eq!((usual.listen.port(), usual.spec.damping_n_s_m, usual.delay_s), (PORT, 0.0, 0.0));
        for (wrong, words) in [
            (remote("elsewhere", "", ""), "`elsewhere` is no address"),
            (remote("", "-1", ""), "`-1` is no damping"),
            (remote("", "much", ""), "`much` is no damping"),
            (remote("", "", "NaN"), "`NaN` is no round trip"),
            (remote("", "", "6000"), "from 0 to 5000 in ms"),
        ] {
            let said = wrong.config(&World::empty("x")).expect_err("wrong");
            assert!(said.contains(words) && said.ends_with('.'), "{said}");
            assert_eq!(wrong.problem(), Some(said));
        }
        assert_eq!(remote("", "", "").problem(), None);
        assert!(remote("", "", "").config(&World::empty("x")).is_err_and(|e| e.contains("/nowhere/key")));
        assert!(Remote::default().config(&World::empty("x")).is_err_and(|e| e.contains("needs a key")));
    }
}
