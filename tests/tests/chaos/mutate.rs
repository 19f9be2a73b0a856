//! Spoils documents at random, in the tree of their JSON.

use rand::RngExt as _;
use rand::rngs::StdRng;
use serde_json::Value;

/// Changes one to three places of a JSON document to what nobody expects there.
pub fn json(whole: &Value, rng: &mut StdRng) -> Value {
    let mut spoiled = whole.clone();
    for _ in 0..rng.random_range(1..4) {
        let places = count(&spoiled);
        let mut place = rng.random_range(0..places);
        change(&mut spoiled, &mut place, rng);
    }
    spoiled
}

fn count(value: &Value) -> usize {
    1 + match value {
        Value::Array(items) => items.iter().map(count).sum(),
        Value::Object(members) => members.values().map(count).sum(),
        _ => 0,
    }
}

/// Walks to the place of that number; true once it was changed.
fn change(value: &mut Value, place: &mut usize, rng: &mut StdRng) -> bool {
    if *place == 0 {
        *value = strange(value, rng);
        return true;
    }
    *place -= 1;
    match value {
        Value::Array(items) => items.iter_mut().any(|item| change(item, place, rng)),
        Value::Object(members) => members.values_mut().any(|member| change(member, place, rng)),
        _ => false,
    }
}

fn strange(value: &Value, rng: &mut StdRng) -> Value {
    const NUMBERS: [f64; 12] =
        [0.0, -0.0, -1.0, 1e-300, 1e300, -1e300, 1e9, 1e-9, 0.5, 4_294_967_296.0, 9.007_199_254_740_993e15, 1e17];
    match rng.random_range(0..9) {
        0 => Value::Null,
        1 => Value::Bool(rng.random()),
        2 => "\u{202e}\n\0../../..".into(),
        3 => Value::Array(vec![value.clone(); rng.random_range(0..40)]),
        4 => serde_json::json!({ "": value }),
        5 => nested(rng.random_range(1..100)),
        // Most documents are numbers: most of what is strange in them, too.
        _ => match value.as_f64() {
            Some(number) if rng.random() => (number * rng.random_range(-3.0..30.0)).into(),
            _ => NUMBERS[rng.random_range(0..NUMBERS.len())].into(),
        },
    }
}

/// Makes one to three numbers of a JSON document up to twice as large or as small: what is still a world is another one.
pub fn numbers(whole: &Value, rng: &mut StdRng) -> Value {
    let mut spoiled = whole.clone();
    for _ in 0..rng.random_range(1..4) {
        let mut found = Vec::new();
        collect(&mut spoiled, &mut found);
        if found.is_empty() {
            break;
        }
        let place = rng.random_range(0..found.len());
        if let Some(number) = found[place].as_f64() {
            *found[place] = (number * 2.0_f64.powf(rng.random_range(-1.0..1.0))).into();
        }
    }
    spoiled
}

/// All numbers with a fraction: the others count or name something.
fn collect<'a>(value: &'a mut Value, into: &mut Vec<&'a mut Value>) {
    match value {
        Value::Array(items) => items.iter_mut().for_each(|item| collect(item, into)),
        Value::Object(members) => members.values_mut().for_each(|member| collect(member, into)),
        number if number.is_f64() => into.push(number),
        _ => {}
    }
}

fn nested(depth: usize) -> Value {
    (0..depth).fold(Value::Null, |inner, _| Value::Array(vec![inner]))
}
