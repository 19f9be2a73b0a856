//! Units as people write them: `kN`, `[mm]`, `N·cm`, `deg/s`, `lbf in`, `um_s`.
//!
//! A unit is a product and quotient of atoms with prefixes and exponents. Its dimension follows from theirs.

mod plain_text;
mod spellings;

use super::units::{Dimension, Unit, split};
use plain_text::{is_factor, tidied, times};
use spellings::{
    Atom, COUNTS, Exponents, FORCE, GRAVITY_M_S2, HABITS, LENGTH, MASS, OTHER, PLAIN, PREFIXED, PREFIXES, PRESSURE,
};

/// Meaning of the text of a unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Written {
    /// A known unit: SI value = number × factor.
    Known(Dimension, f64),
    /// Counts of a converter, an encoder, or a scale without a unit.
    Counts,
    /// Not known.
    Unknown,
}

/// Meaning of a unit's text for a quantity of one of these dimensions, or of any if there are none. A mass stands for its
/// weight where a force is wanted.
pub fn parse(text: &str, wanted: &[Dimension]) -> Written {
    let text = tidied(text);
    let (number, text) = times(&text);
    let habit = HABITS.iter().find(|(habit, dimension, _)| *habit == text && wanted.contains(dimension));
    if let Some(&(_, dimension, factor)) = habit {
        return Written::Known(dimension, number * factor);
    }
    let readings = [Case::Kept, Case::Free, Case::FreeProduct].map(|case| product(&text, case));
    let mut named = readings.into_iter().flatten().map(|found| named(found, wanted));
    let first = named.clone().next();
    let fitting = named.find(|(dimension, _)| wanted.is_empty() || wanted.contains(dimension));
    match fitting.or(first) {
        Some((dimension, factor)) => Written::Known(dimension, number * factor),
        None if COUNTS.contains(&text.to_lowercase().as_str()) => Written::Counts,
        None => Written::Unknown,
    }
}

/// Regard to capitals.
#[derive(Clone, Copy, PartialEq)]
enum Case {
    /// `mN` is no `MN`.
    Kept,
    /// `MM` is `mm`.
    Free,
    /// `nm` is `N m`.
    FreeProduct,
}

/// Exponents and factor of a product of units.
fn product(text: &str, case: Case) -> Option<(Exponents, f64)> {
    let mut parts: Vec<&str> = text.split('/').map(str::trim).collect();
    // In a column's name, a rate is written `mm_s`.
    if let ([only], Some((above, below))) = (parts.as_slice(), text.split_once('_'))
        && factor_of(below, case).is_some_and(|(exponents, _)| exponents[1] > 0 && exponents[0] == 0)
        && !only.is_empty()
    {
        parts = vec![above, below];
    }
    let mut whole = ([0; 5], 1.0);
    for (k, part) in parts.iter().enumerate() {
        if k == 0 && *part == "1" && parts.len() > 1 {
            continue;
        }
        let (exponents, factor) = factor_of(part, case)?;
        let sign = if k == 0 { 1 } else { -1 };
        (0..5).for_each(|i| whole.0[i] += sign * exponents[i]);
        whole.1 *= factor.powi(sign);
    }
    Some(whole)
}

/// A product without a quotient: `N.m`, `N m`, `lbf-in`, `Nm`.
fn factor_of(text: &str, case: Case) -> Option<(Exponents, f64)> {
    let mut whole = ([0; 5], 1.0);
    let mut join = |(exponents, factor): (Exponents, f64), power: i32| {
        (0..5).for_each(|i| whole.0[i] += power * exponents[i]);
        whole.1 *= factor.powi(power);
    };
    let is_joint = |c: char| matches!(c, '.' | ' ' | '_');
    // A hyphen before a digit is the sign of an exponent.
    let hyphens = text
        .char_indices()
        .filter(|&(at, c)| c == '-' && text[at + 1..].chars().next().is_some_and(|next| !next.is_ascii_digit()));
    let hyphens: Vec<usize> = hyphens.map(|(at, _)| at).collect();
    let tokens = text.char_indices().filter(|&(at, c)| is_joint(c) || hyphens.contains(&at));
    let cuts: Vec<usize> = tokens.map(|(at, _)| at).collect();
    let starts = std::iter::once(0).chain(cuts.iter().map(|at| at + 1));
    let ends = cuts.iter().copied().chain(std::iter::once(text.len()));
    for (start, end) in starts.zip(ends).filter(|(start, end)| start < end) {
        let token = &text[start..end];
        let digits = token.find(|c: char| c.is_ascii_digit() || c == '-').unwrap_or(token.len());
        let (name, power) = token.split_at(digits);
        let power: i32 =
            if power.is_empty() { 1 } else { power.parse().ok().filter(|p| (-3..=3).contains(p) && *p != 1)? };
        let atoms = atoms(name, case)?;
        let last = atoms.len() - 1;
        atoms.into_iter().enumerate().for_each(|(k, atom)| join(atom, if k == last { power } else { 1 }));
    }
    (!text.trim().is_empty()).then_some(whole)
}

/// The atoms of a word: one if it can be, otherwise two or three in a row.
fn atoms(word: &str, case: Case) -> Option<Vec<(Exponents, f64)>> {
    if let Some(one) = atom(word, case).filter(|_| case != Case::FreeProduct || word.len() < 2) {
        return Some(vec![one]);
    }
    let cuts: Vec<usize> = word.char_indices().map(|(at, _)| at).skip(1).collect();
    let cuts = cuts.into_iter().rev().find_map(|at| {
        let first = atom(&word[..at], case)?;
        // Only products of a force, or a weight, and lengths are written together.
        let rest = atom(&word[at..], case)?;
        let is_moment = |a: Exponents, b: Exponents| (a == FORCE || a == MASS) && b == LENGTH;
        (is_moment(first.0, rest.0) || is_moment(rest.0, first.0)).then(|| vec![first, rest])
    });
    cuts.or_else(|| (case == Case::FreeProduct).then(|| atom(word, Case::Free)).flatten().map(|one| vec![one]))
}

fn atom(word: &str, case: Case) -> Option<(Exponents, f64)> {
    let is = |spelling: &str, word: &str| {
        let words = spelling.len() > 2 && word.eq_ignore_ascii_case(spelling);
        spelling == word || words || case != Case::Kept && spelling.eq_ignore_ascii_case(word)
    };
    let find = |atoms: &[Atom], word: &str| {
        atoms.iter().find(|(spellings, ..)| spellings.iter().any(|s| is(s, word))).map(|&(_, e, f)| (e, f))
    };
    let prefixed = |(prefixes, by): &(&[&str], f64)| {
        prefixes.iter().find_map(|prefix| {
            // Megas keep their capital: `mn` is a millinewton.
            let rest = word
                .get(..prefix.len())
                .filter(|start| is(prefix, start) && (*by < 1e6 || start == prefix))
                .map(|_| &word[prefix.len()..])?;
            let (exponents, factor) = find(&PREFIXED, rest)?;
            // A mega of a length, a time or an angle is a capital that a spreadsheet made.
            let fits = *by < 1e6 || exponents == FORCE || exponents == PRESSURE || exponents == OTHER;
            // Words go with words: no `millim`.
            let is_sign = !prefix.is_ascii() || prefix.len() <= 2;
            let spelled = is_sign || rest.len() > 2;
            (fits && spelled).then_some((exponents, by * factor))
        })
    };
    find(&PLAIN, word).or_else(|| find(&PREFIXED, word)).or_else(|| PREFIXES.iter().find_map(prefixed))
}

/// Dimension and factor of a product for a quantity of these dimensions.
fn named((exponents, factor): (Exponents, f64), wanted: &[Dimension]) -> (Dimension, f64) {
    let dimension = match exponents {
        [1, 0, 0, 0, 0] => Dimension::Length,
        [0, 1, 0, 0, 0] => Dimension::Time,
        [0, 0, 1, 0, 0] | [1, -2, 0, 1, 0] => Dimension::Force,
        [0, 0, 0, 0, 1] => Dimension::Angle,
        [1, 0, 1, 0, 0] => Dimension::Torque,
        [1, -1, 0, 0, 0] => Dimension::Velocity,
        [0, -1, 0, 0, 1] => Dimension::AngularVelocity,
        [1, -2, 0, 0, 0] => Dimension::Acceleration,
        [0, -2, 0, 0, 1] => Dimension::AngularAcceleration,
        // A mass that stands for its weight.
        [0, 0, 0, 1, 0] if wanted.contains(&Dimension::Force) => return (Dimension::Force, factor * GRAVITY_M_S2),
        [1, 0, 0, 1, 0] if wanted.contains(&Dimension::Torque) => return (Dimension::Torque, factor * GRAVITY_M_S2),
        _ => Dimension::Other,
    };
    (dimension, factor)
}

/// Name and unit text of a column's header: `Fx1 [N]`, `Weg (mm)`, `Kraft in kN`, `speed/rpm`, `load lbf`, `torque_Ncm`.
/// The text is empty if the header states no unit.
pub fn in_header<'a>(header: &'a str, wanted: &[Dimension]) -> (&'a str, &'a str) {
    let header = header.trim();
    if let Some((quantity, Unit { symbol, .. })) = split(header) {
        return (quantity, &header[header.len() - symbol.len()..]);
    }
    let groups = bracketed(header);
    // `position[a]` is that of a joint, `force[A]` a current.
    let is_item = |group: &Bracketed<'a>, dimension| {
        let is_joint = group.inside.len() == 1 && product(group.inside, Case::Kept).is_none();
        group.may_be_item && is_joint && !wanted.contains(&dimension)
    };
    let is_read = |group: &&Bracketed<'a>| match parse(group.inside, wanted) {
        Written::Unknown => false,
        Written::Known(dimension, _) if is_item(group, dimension) => false,
        _ if group.is_last => true,
        Written::Known(dimension, _) => dimension != Dimension::Other && !group.may_be_item,
        Written::Counts => false,
    };
    let last = groups.last().filter(|group| group.is_last);
    if let Some(group) = last.into_iter().chain(&groups).find(is_read) {
        return (group.name, group.inside);
    }
    if let Some(group) = last {
        return if group.may_be_item { (header, "") } else { (group.name, group.inside) };
    }
    // A word behind *in* is meant as a unit, whether it is known or not.
    if let Some((name, word)) = header.split_once(" in ")
        && word.len() > 1
        && !word.contains(' ')
    {
        return (name.trim(), word);
    }
    without_brackets(header, wanted)
}

/// Name and unit text of a header that names a unit in words, behind a sign, or at the end of its name.
fn without_brackets<'a>(header: &'a str, wanted: &[Dimension]) -> (&'a str, &'a str) {
    // A share of a range is no unit of a quantity, and only the user knows the range.
    if let Some(name) = header.strip_suffix('%').filter(|name| !name.is_empty()) {
        return (name.trim_end_matches(['_', ' ']), "%");
    }
    let is_unit = |text: &str| parse(text, wanted) != Written::Unknown;
    let spoken = [" in ", " / ", "/", ", ", ",", "_in_", "|"].iter().flat_map(|mark| {
        let places = header.match_indices(mark).map(|(at, mark)| (at, at + mark.len()));
        places.filter(|&(at, from)| at > 0 && is_unit(&header[from..]))
    });
    let is_loose = |text: &str| !text.starts_with("in ") && !text.starts_with("in_") && is_suffix(text, wanted);
    let loose = header.match_indices(['_', ' ', '.', '-']).map(|(at, _)| (at, at + 1));
    let loose = loose.filter(|&(at, from)| at > 0 && is_loose(&header[from..]));
    // `positionMm`: a capital behind a small letter begins a word.
    let joined = || {
        let pairs = header.char_indices().zip(header.char_indices().skip(1));
        let mut places = pairs.filter(|((_, a), (_, b))| a.is_lowercase() && b.is_uppercase()).map(|(_, (at, _))| at);
        places.find_map(|at| is_suffix(&header[at..], wanted).then_some((at, at)))
    };
    // `force_kN_raw`: a sign of a unit between words that are none.
    let between = || {
        let cuts: Vec<usize> = header.match_indices(['_', ' ', '.', '-']).map(|(at, _)| at).collect();
        cuts.windows(2).find_map(|cut| is_sign(&header[cut[0] + 1..cut[1]]).then_some((cut[0], cut[1])))
    };
    // The stroke in `speed mm/s` belongs to the unit: the longest text is the whole of it.
    let suffix = spoken.chain(loose).min_by_key(|(_, from)| *from);
    let is_known = suffix.is_some_and(|(_, from)| matches!(parse(&header[from..], wanted), Written::Known(..)));
    if let Some((at, end)) = between().filter(|(at, _)| !is_known && *at > 0) {
        return (header[..at].trim(), &header[at + 1..end]);
    }
    suffix.or_else(joined).map_or((header, ""), |(at, from)| (header[..at].trim(), header[from..].trim()))
}

/// True for the sign of a mechanical unit that is no word, and no abbreviation of one as *sec* and *in* are.
fn is_sign(text: &str) -> bool {
    (2..=3).contains(&text.len())
        && !matches!(text.to_lowercase().as_str(), "in" | "min")
        && matches!(parse(text, &[]), Written::Known(dimension, _) if !matches!(dimension, Dimension::Other | Dimension::Time))
}

/// Brackets around units, those of East Asian fonts and apostrophes included.
const BRACKETS: [(char, char); 8] =
    [('[', ']'), ('(', ')'), ('{', '}'), ('<', '>'), ('（', '）'), ('［', '］'), ('【', '】'), ('\'', '\'')];

/// Text in brackets of a header.
struct Bracketed<'a> {
    name: &'a str,
    inside: &'a str,
    /// True if nothing stands behind it. Others state a unit only if it is known: `Load (kN) Test 1`, `Force [N] (filtered)`.
    is_last: bool,
    /// True for `position[elbow]` and `q[0]`, items of lists, and for words in quotes.
    may_be_item: bool,
}

/// The texts in brackets behind a name, or before it as in `[kN] Force`, in their order.
fn bracketed(header: &str) -> Vec<Bracketed<'_>> {
    let opened = header.char_indices().filter_map(|(at, c)| Some((at, BRACKETS.iter().find(|(open, _)| *open == c)?)));
    let group = |(at, (open, close)): (usize, &(char, char))| {
        let (name, rest) = (&header[..at], &header[at + open.len_utf8()..]);
        let (inside, behind) = rest.split_once(*close)?;
        let may_be_item = *open == '[' && !name.is_empty() && !name.ends_with(' ') || *open == '\'';
        let is_last = !name.is_empty() && (behind.is_empty() || is_factor(behind));
        // A factor behind the brackets belongs to what stands in them: `(N) x10`.
        let inside = if is_factor(behind) { &header[at..] } else { inside };
        let name = if name.is_empty() { behind } else { name };
        (!name.trim().is_empty()).then_some(Bracketed {
            name: name.trim(),
            inside: inside.trim(),
            is_last,
            may_be_item,
        })
    };
    opened.filter_map(group).collect()
}

/// Units that are words of names, too.
const SHORT_WORDS: [&str; 9] = ["in", "min", "step", "inc", "digit", "bar", "amp", "amps", "day"];

/// True for a unit behind a mere blank, point or underscore. Numbers, single letters, and words such as *in* and *bar* are more
/// likely part of a name, unless they fit the quantity.
fn is_suffix(text: &str, wanted: &[Dimension]) -> bool {
    let is_short = text.len() == 1 || SHORT_WORDS.contains(&text.to_lowercase().as_str());
    let is_rate = ["_s", "/s", "s2", "s^2", "s²"].iter().any(|end| text.ends_with(end));
    match parse(text, wanted) {
        Written::Known(dimension, _) if text.contains(|c: char| c.is_ascii_digit()) => {
            (is_rate || times(&tidied(text)).0 < 1.0) && dimension != Dimension::Other
        }
        Written::Known(dimension, _) if is_short => wanted.contains(&dimension),
        Written::Known(..) => true,
        Written::Counts => !is_short,
        Written::Unknown => false,
    }
}

#[cfg(test)]
mod tests;
