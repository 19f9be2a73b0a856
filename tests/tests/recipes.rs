//! What README and `docs/scripting.md` say can be done runs as it is written: the first five minutes, and the recipes that fan a fleet of logs out.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;
use tests::{touchstone, workspace};

fn document(name: &str) -> String {
    std::fs::read_to_string(workspace().join(name)).expect("a document")
}

/// The code block of a document in which `word` stands.
fn block(name: &str, word: &str) -> String {
    let text = document(name);
    let blocks = ["```bash\n", "```python\n"].into_iter().flat_map(|begins| text.split(begins).skip(1));
    let mut blocks = blocks.filter_map(|rest| rest.split("```").next());
    blocks.find(|block| block.contains(word)).expect("a recipe").to_owned()
}

/// Runs a recipe in a folder where `logs` lies; standard error where it failed.
fn run(recipe: &str, folder: &Path, variables: &[(&str, &str)]) -> Result<(), String> {
    let program = touchstone().parent().expect("a folder").to_path_buf();
    let others = std::env::var_os("PATH").unwrap_or_default();
    let path = std::env::join_paths(std::iter::once(program).chain(std::env::split_paths(&others))).expect("folders");
    let mut bash = Command::new("bash");
    bash.args(["-c", recipe]).current_dir(folder).env("PATH", path).envs(variables.iter().copied());
    let output = bash.output().map_err(|e| e.to_string())?;
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    output.status.success().then_some(()).ok_or(said)
}

/// Records a short log of the scripted operator.
fn record(log: &Path, seed: &str) {
    std::fs::create_dir_all(log.parent().expect("a folder")).expect("a folder");
    let arguments = ["record", "--task", "crank", "--operator", "scripted", "--seed", seed, "--out"];
    let output = Command::new(touchstone()).args(arguments).arg(log).output().expect("the program starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// What stands in `results`, by name.
fn results(folder: &Path) -> BTreeMap<String, String> {
    let files = std::fs::read_dir(folder.join("results")).expect("the recipe makes the folder");
    let file = |entry: std::io::Result<std::fs::DirEntry>| {
        let path = entry.expect("an entry").path();
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        (name, std::fs::read_to_string(&path).expect("lines"))
    };
    files.map(file).collect()
}

/// Lines of all files, each a log that was diagnosed.
fn diagnosed(found: &BTreeMap<String, String>) -> usize {
    let lines: Vec<serde_json::Value> =
        found.values().flat_map(|text| text.lines()).map(|l| serde_json::from_str(l).expect("JSON")).collect();
    assert!(lines.iter().all(|line| line["result"].is_object()), "{lines:?}");
    lines.len()
}

#[test]
fn the_first_five_minutes_go_as_the_readme_says() {
    let text = document("README.md");
    let section = text.split("\n## ").find(|part| part.starts_with("Five minutes")).expect("the section is there");
    // `./run` builds the program and hands its arguments on.
    let commands: Vec<String> = section
        .lines()
        .flat_map(|line| line.split('`').map(str::trim).filter(|word| word.starts_with("./run ")))
        .filter(|command| !command.starts_with("./run app"))
        .map(|command| command.replace("./run", "touchstone"))
        .collect();
    assert_eq!(commands.len(), 4, "record, segment, fit, simulate: {commands:?}");
    let folder = tempfile::tempdir().expect("a folder");
    for command in &commands {
        run(command, folder.path(), &[]).unwrap_or_else(|said| panic!("{command}: {said}"));
    }
    let order = "touchstone segment stack.csv | grep -q 'sequence: 132313231'";
    run(order, folder.path(), &[]).expect("the order that the README tells");
    assert!(section.contains("`sequence: 132313231`"));
    for made in ["stack.csv", "stack.meta.json", "blocks.json", "predicted.csv"] {
        assert!(folder.path().join(made).is_file(), "{made}");
    }
}

#[test]
fn ray_fans_out_as_the_manual_says() {
    let python = std::env::var_os("TOUCHSTONE_PYTHON").unwrap_or_else(|| "python3".into());
    if !Command::new(&python).args(["-c", "import ray"]).output().is_ok_and(|output| output.status.success()) {
        tests::skipped("the Python package ray is not here");
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    record(&folder.path().join("logs/a.mcap"), "1");
    record(&folder.path().join("logs/b.mcap"), "2");
    std::fs::write(folder.path().join("recipe.py"), block("docs/scripting.md", "@ray.remote")).expect("written");
    run(&format!("'{}' recipe.py", python.display()), folder.path(), &[]).expect("the recipe runs");
    let found = results(folder.path());
    assert_eq!((found.len(), diagnosed(&found)), (2, 2));
}

#[test]
fn gnu_parallel_fans_out_as_the_readme_says_and_goes_on_when_logs_are_added() {
    if Command::new("parallel").arg("--version").output().is_err() {
        tests::skipped("GNU parallel is not here");
        return;
    }
    let recipe = block("README.md", "| parallel");
    let commands = |text: &str| text.lines().filter(|l| !l.starts_with('#')).map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(commands(&recipe), commands(&block("docs/scripting.md", "| parallel")), "both say the same");
    let folder = tempfile::tempdir().expect("a folder");
    let logs = folder.path().join("logs");
    // Two of one name, and one that a shell must not take apart.
    record(&logs.join("monday/a.mcap"), "1");
    record(&logs.join("it's tuesday/a.mcap"), "2");
    run(&recipe, folder.path(), &[]).expect("the recipe runs");
    let first = results(folder.path());
    assert_eq!((first.len(), diagnosed(&first)), (2, 2), "a file for each log: {:?}", first.keys());
    assert!(first.keys().all(|name| name.len() == 12 + ".jsonl".len()), "short names: {:?}", first.keys());
    record(&logs.join("0 before/b.mcap"), "3");
    run(&recipe, folder.path(), &[]).expect("it goes on");
    let second = results(folder.path());
    assert_eq!((second.len(), diagnosed(&second)), (3, 3));
    assert!(first.iter().all(|(name, lines)| second.get(name) == Some(lines)), "what was done is not done again");
}

#[test]
fn the_slurm_array_deals_out_every_log_once_and_keeps_to_it_when_logs_are_added() {
    let recipe = block("docs/scripting.md", "SBATCH");
    let folder = tempfile::tempdir().expect("a folder");
    let logs = folder.path().join("logs");
    let all = || {
        for task in 0..100 {
            let task = task.to_string();
            let variables = [("SLURM_ARRAY_TASK_ID", task.as_str()), ("SLURM_CPUS_PER_TASK", "2")];
            run(&recipe, folder.path(), &variables).expect("the recipe runs");
        }
        results(folder.path())
    };
    record(&logs.join("a.mcap"), "1");
    record(&logs.join("b c.mcap"), "2");
    let first = all();
    assert_eq!(diagnosed(&first), 2);
    record(&logs.join("0.mcap"), "3");
    let second = all();
    assert_eq!(diagnosed(&second), 3);
    assert!(first.iter().all(|(name, lines)| second[name].starts_with(lines.as_str())), "nobody's log changes hands");
}
