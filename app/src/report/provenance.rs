//! Provenance of a report: the program, its arguments, the date.

use jiff::Timestamp;

/// Versions and conditions of one run.
#[derive(Clone, Debug)]
pub struct Provenance {
    /// The program's version.
    pub version: &'static str,
    /// Revision of the sources, if the build knew it: given by `TOUCHSTONE_REVISION`, or asked of git by a release
    /// build.
    pub revision: Option<&'static str>,
    /// Target system and processor of the build.
    pub platform: String,
    /// The command line.
    pub command: String,
    /// Date in UTC. `SOURCE_DATE_EPOCH` fixes it, for reproducible reports.
    pub date: String,
}

impl Provenance {
    /// Provenance of this run.
    pub fn now() -> Self {
        let arguments: Vec<String> = std::env::args_os().map(|a| quoted(&a.to_string_lossy())).collect();
        let program = std::env::args_os().next().map(std::path::PathBuf::from);
        let program = program.and_then(|p| p.file_name().map(|n| n.to_string_lossy().into_owned()));
        let command = std::iter::once(program.unwrap_or_else(|| "touchstone".to_owned()))
            .chain(arguments.into_iter().skip(1))
            .collect::<Vec<_>>()
            .join(" ");
        let fixed = std::env::var("SOURCE_DATE_EPOCH").ok().and_then(|s| s.parse().ok());
        let at = fixed.and_then(|s| Timestamp::from_second(s).ok()).unwrap_or_else(Timestamp::now);
        Self {
            version: env!("CARGO_PKG_VERSION"),
            revision: revision(),
            platform: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            command,
            date: date(at),
        }
    }
}

/// Revision of the sources, as in [`Provenance::revision`].
pub fn revision() -> Option<&'static str> {
    option_env!("TOUCHSTONE_REVISION").filter(|r| !r.is_empty())
}

fn date(at: Timestamp) -> String {
    at.strftime("%Y-%m-%d %H:%M UTC").to_string()
}

/// Argument, quoted for a shell.
fn quoted(argument: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=+:,@%".contains(c);
    if !argument.is_empty() && argument.chars().all(plain) {
        return argument.to_owned();
    }
    format!("'{}'", argument.replace('\'', r"'\''"))
}

#[cfg(test)]
#[path = "../../build/revision.rs"]
mod of_checkout;

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write as _;
    use std::path::Path;
    use std::process::Command;

    /// Runs git; false if git is not installed.
    fn git(folder: &Path, arguments: &[&str]) -> bool {
        let who = ["-c", "user.name=Ada", "-c", "user.email=ada@example.org", "-c", "init.defaultBranch=main"];
        let output = Command::new("git").arg("-C").arg(folder).args(who).args(arguments).output();
        output.is_ok_and(|output| output.status.success())
    }

    #[test]
    fn a_checkout_and_a_linked_worktree_know_their_revision() {
        let folder = tempfile::tempdir().expect("a folder");
        let (main, linked) = (folder.path().join("main"), folder.path().join("linked"));
        std::fs::create_dir_all(main.join("inner")).expect("a folder");
        if !git(&main, &["init", "--quiet"]) {
            // Not by `println!`, which the harness captures when a test passes.
            let _ = writeln!(std::io::stderr(), "skipped: there is no git");
            return;
        }
        assert!(of_checkout::of(&main).is_none(), "nothing was committed");
        std::fs::write(main.join("inner/a"), "1").expect("written");
        assert!(git(&main, &["add", "."]) && git(&main, &["commit", "--quiet", "--message", "One"]));
        assert!(git(&main, &["worktree", "add", "--quiet", "-b", "other", linked.to_str().expect("a plain path")]));
        let first = of_checkout::of(&main).expect("a revision");
        let noted = first.noted_in.as_deref().expect("git notes commits");
        assert!(noted.ends_with("logs/HEAD") && noted.exists());
        assert!(of_checkout::of(&main.join("inner")).is_none(), "an archive within another project's checkout");
        std::fs::write(linked.join("inner/a"), "2").expect("written");
        let changed = of_checkout::of(&linked).expect("a revision");
        assert_eq!(changed.name, format!("{}-dirty", first.name));
        assert!(git(&linked, &["commit", "--quiet", "--all", "--message", "Two"]));
        let second = of_checkout::of(&linked).expect("a revision");
        assert!(second.name != first.name && !second.name.contains("dirty"), "{second:?}");
        assert_ne!(second.noted_in, first.noted_in, "each has notes of its own");
    }

    #[test]
    fn arguments_can_be_pasted() {
        assert_eq!(quoted("a/b.csv"), "a/b.csv");
        assert_eq!(quoted("it's <a>.csv"), r"'it'\''s <a>.csv'");
        assert_eq!(quoted(""), "''");
    }

    #[test]
    fn a_date_is_that_of_its_second() {
        assert_eq!(date(Timestamp::from_second(86_400 * 365).expect("a time")), "1971-01-01 00:00 UTC");
    }
}
