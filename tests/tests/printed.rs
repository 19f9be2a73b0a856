//! A report in a real browser: headless Chromium opens it without a network and prints it. Skipped with a word where there is none.

use std::path::Path;
use std::process::{Command, Stdio};
use tests::{skipped, touchstone, workspace};

/// The names that Chromium goes by.
const BROWSERS: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

fn answers(program: &str) -> bool {
    let mut asked = Command::new(program);
    asked.arg("--version").stdout(Stdio::null()).stderr(Stdio::null());
    asked.status().is_ok_and(|status| status.success())
}

/// What a program prints, or nothing where it is missing.
fn said(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok().filter(|output| output.status.success())?;
    Some(String::from_utf8_lossy(&output.stdout).into_owned())
}

fn printed(browser: &str, page: &Path, home: &Path) -> Vec<u8> {
    let out = home.join("report.pdf");
    let output = Command::new(browser)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--no-pdf-header-footer"])
        // It gives up by itself, ms.
        .arg("--timeout=60000")
        // Whatever it would fetch is not there.
        .arg("--host-resolver-rules=MAP * ~NOTFOUND")
        .arg(format!("--user-data-dir={}", home.display()))
        .arg(format!("--print-to-pdf={}", out.display()))
        .arg(format!("file://{}", page.display()))
        .output()
        .expect("it was there a moment ago");
    std::fs::read(&out).unwrap_or_else(|_| panic!("nothing was printed: {}", String::from_utf8_lossy(&output.stderr)))
}

#[test]
fn a_report_prints_on_some_sheets_with_everything_on_them() {
    let Some(browser) = BROWSERS.into_iter().find(|name| answers(name)) else {
        skipped("Chromium is not installed: the report is not printed");
        return;
    };
    let folder = tempfile::tempdir().expect("a folder");
    let page = folder.path().join("report.html");
    let logs = ["crank.csv", "stack.csv"].map(|name| workspace().join("assets/recordings").join(name));
    let done =
        Command::new(touchstone()).arg("report").args(&logs).arg("--out").arg(&page).output().expect("it starts");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let pdf = printed(browser, &page, folder.path());
    assert!(pdf.starts_with(b"%PDF-") && pdf.len() > 50_000, "{} bytes", pdf.len());
    let file = folder.path().join("report.pdf");
    let file = file.to_str().expect("a plain path");
    let (Some(facts), Some(words)) = (said("pdfinfo", &[file]), said("pdftotext", &["-layout", file, "-"])) else {
        skipped("pdfinfo and pdftotext are not installed: what is on the sheets is not read");
        return;
    };
    let sheets = facts.lines().find_map(|line| line.strip_prefix("Pages:")?.trim().parse::<usize>().ok());
    assert!(sheets.is_some_and(|sheets| (3..=20).contains(&sheets)), "{facts}");
    for part in ["crank.csv", "stack.csv", "Parameters", "Diagnosis", "What could not be known", "How to repeat this"] {
        assert!(words.contains(part), "{part} is on no sheet:\n{words}");
    }
}
