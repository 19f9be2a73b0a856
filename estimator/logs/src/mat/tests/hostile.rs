//! Files that were cut, flipped, or made to claim more than they hold.

use super::*;
use proptest::prelude::*;

fn sample() -> Vec<(&'static str, V)> {
    let matrix = V::Doubles(vec![6, 2], [Q, F].concat());
    let inner = one(vec![("data", matrix), ("names", texts(&["a", "b"])), ("T", V::Object("table"))]);
    vec![("t_s", column(&clock())), ("q_m", column(&Q)), ("log", inner), ("note", V::Chars(vec!["ab", "cd"]))]
}

fn files() -> Vec<Vec<u8>> {
    let mut files: Vec<Vec<u8>> = Form::ALL.map(|form| form.file(&sample())).to_vec();
    for big in [false, true] {
        let of = |name, values: &[f64]| level4(big, 0, name, values.len() as u32, 1, values);
        files.push([of("t_s", &clock()), of("q_m", &Q), level4(big, 1, "who", 1, 2, &[65.0, 66.0])].concat());
    }
    files
}

/// A recording or one sentence.
fn must_end_well(bytes: &[u8]) {
    if let Err(error) = loaded(bytes, "{}") {
        let text = error.to_string();
        assert!(!text.contains('\n') && text.ends_with("log.data"), "{text}");
    }
}

#[test]
fn cut_files_are_damaged() {
    for file in files() {
        let whole = loaded(&file, "{}").unwrap_or_else(|e| panic!("{e}")).remove(0);
        for length in 1..file.len() {
            let Ok(cut) = loaded(&file[..length], "{}") else { continue };
            // Cut between two variables: those before the cut are whole.
            let same =
                |channel: &haptics::recording::Channel| whole.channel(&channel.name) == Some(channel.values.as_slice());
            assert!(cut[0].channels.iter().all(same), "{length}");
        }
        let middle = loaded(&file[..file.len() - 3], "{}").expect_err("cut").to_string();
        assert!(middle.contains("MATLAB file is damaged"), "{middle}");
    }
}

#[test]
fn flipped_bits_end_well_and_packed_numbers_never_change() {
    for (at, file) in files().into_iter().enumerate() {
        let whole = loaded(&file, "{}").unwrap_or_else(|e| panic!("{e}")).remove(0);
        let is_packed = at == 1 || at == 3;
        for place in 0..file.len() {
            let mut broken = file.clone();
            broken[place] ^= 1 << (place % 8);
            match loaded(&broken, "{}") {
                // A variable may be passed over, for a tag that is another one.
                Ok(read) if is_packed => {
                    let same = |c: &haptics::recording::Channel| whole.channel(&c.name) == Some(c.values.as_slice());
                    assert!(read[0].channels.iter().all(same), "file {at}, byte {place}: {read:?}");
                }
                Ok(_) => {}
                Err(error) => assert!(!error.to_string().contains('\n'), "{error}"),
            }
        }
    }
}

#[test]
fn claims_beyond_the_bytes_are_refused() {
    for form in Form::ALL {
        let refused = |element: Vec<u8>| loaded(&form.of_elements(&[element]), "{}").expect_err("a claim").to_string();
        let word = |value: u32| if form.big { value.to_be_bytes() } else { value.to_le_bytes() };
        let doubles = form.element(9, &[0; 48]);
        // Dimensions, numbers of cells and of structures.
        for dims in [[u32::MAX >> 1, 1], [1 << 20, 1 << 20], [7, 1]] {
            assert!(refused(form.array(6, &dims, "a", std::slice::from_ref(&doubles))).contains("its dimensions"));
            assert!(refused(form.array(1, &dims, "a", &[])).contains("claim"));
            let fields = [form.element(5, &word(8)), form.element(1, b"field\0\0\0")];
            assert!(refused(form.array(2, &dims, "a", &fields)).contains("claim"));
        }
        assert!(refused(form.array(6, &[1 << 31 | 1; 9], "a", &[])).contains("damaged"));
        let nameless = form.array(2, &[u32::MAX >> 1, 1], "a", &[form.element(5, &word(8)), form.element(1, b"")]);
        assert!(refused(nameless).contains("no variable is a vector of samples"), "structures without fields");
        let blank = form.array(4, &[u32::MAX >> 1, 0], "a", &[form.element(4, b"")]);
        assert!(refused(blank).contains("no variable is a vector of samples"), "rows without characters");
        // An element longer than what it stands in.
        let long = [&word(9)[..], &word(u32::MAX)].concat();
        assert!(refused(form.array(6, &[6, 1], "a", &[long])).contains("bytes are claimed where"));
    }
}

#[test]
fn values_that_nest_without_end_are_refused() {
    for form in Form::ALL {
        let deep = (0..2000).fold(column(&[1.0]), |inner, _| V::Cells(vec![1, 1], vec![inner]));
        // The writer nests, too: it has a stack of its own.
        let write = move || form.file(&[("a", deep)]);
        let file =
            std::thread::Builder::new().stack_size(64 << 20).spawn(write).expect("a thread").join().expect("written");
        let text = loaded(&file, "{}").expect_err("deep").to_string();
        assert!(text.contains("more than 24 deep"), "{text}");
    }
}

#[test]
fn a_bomb_is_refused_before_it_fills_the_memory() {
    let form = Form::ALL[1];
    // 40 MB of zeros from 40 kB: they would become 320 MB of doubles.
    let size = 40_u32 << 20;
    let head = form.array(9, &[size, 1], "a", &[]);
    let tag = [2_u32.to_le_bytes(), size.to_le_bytes()].concat();
    let length = head.len() as u32 + size;
    let mut whole = [&14_u32.to_le_bytes()[..], &length.to_le_bytes(), &head[8..], &tag].concat();
    whole.resize(whole.len() + size as usize, 0);
    let file = form.of_elements(&[whole]);
    assert!(file.len() < 1 << 20);
    let text = loaded(&file, "{}").expect_err("a bomb").to_string();
    assert!(text.contains("unpacks to more values than a file of its size holds"), "{text}");
    // A claim of a gigabyte behind a few packed bytes is more than those can hold.
    let claim = [&14_u32.to_le_bytes()[..], &(1_u32 << 30).to_le_bytes(), &head[8..]].concat();
    let text = loaded(&form.of_elements(&[claim]), "{}").expect_err("a claim").to_string();
    assert!(text.contains("bytes are claimed where"), "{text}");
}

#[test]
fn text_and_other_files_are_no_variables_of_level_4() {
    let header = |words: [u32; 5]| words.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>();
    let refused = |bytes: Vec<u8>| loaded(&bytes, "{}").expect_err("no file of MATLAB").to_string();
    let body = [b"q_m\0".to_vec(), vec![0; 16]].concat();
    let whole = [header([0, 2, 1, 0, 4]), body.clone()].concat();
    assert!(loaded(&whole, "{}").is_ok());
    for words in [
        [2, 2, 1, 0, 9],
        [70, 2, 1, 0, 4],
        [0, 3, 1, 0, 4],
        [0, 2, 1, 2, 4],
        [0, 2, 1, 0, 3],
        [3, 2, 1, 0, 4],
        [2000, 2, 1, 0, 4],
    ] {
        let text = refused([header(words), body.clone()].concat());
        assert!(text.contains("binary data"), "{words:?}: {text}");
    }
    assert!(refused(vec![0; 200]).contains("binary data"));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn nothing_panics_behind_a_header(bytes in proptest::collection::vec(any::<u8>(), 0..400), at in 0..6_usize, cut in 0..2000_usize) {
        let mut file = files().remove(at);
        file.truncate(cut.max(128).min(file.len()));
        file.extend(bytes);
        must_end_well(&file);
    }
}
