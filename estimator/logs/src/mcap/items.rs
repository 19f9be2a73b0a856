//! Items of lists by their names: `position[0]` of a `JointState` becomes `position[elbow]`, at whatever place a message
//! lists the elbow.

use super::topic::{MAX_ITEMS, Topic, split_item};
use crate::raw::{Cells, MISSING, is_missing};
use haptics::recording::Labels;
use std::collections::{BTreeMap, HashMap, HashSet};

/// Bytes that lists may take once their items are named; names that change all the time would need a column each.
const NAMED_BYTES: usize = 256 << 20;

/// An item by its place in the list.
#[derive(Debug, PartialEq, Eq)]
pub struct Place {
    /// `position[0]`.
    pub field: String,
    /// The fields that it became, such as `position[elbow]`: several where names change.
    pub named: Vec<String>,
}

/// Names the items of all lists that stand beside a list of names. Sentences about names that move go to `said`.
pub fn name_items(topic: &mut Topic, said: &mut Vec<String>) -> Vec<Place> {
    let mut places = Vec::new();
    for list in lists(topic) {
        let names = columns(topic, &list);
        let parallel = parallel(topic, &list, names.len());
        if parallel.is_empty() {
            continue;
        }
        let Some(order) = Order::of(topic, &names, &parallel) else { continue };
        said.extend(order.moves(&list));
        places.extend(order.places(&parallel));
        rename(topic, &list, &order, &parallel);
    }
    places
}

/// Paths of the lists of names, such as `name` or `joint_names`.
fn lists(topic: &Topic) -> Vec<String> {
    let mut found = Vec::new();
    for (field, cells) in topic.fields.iter().zip(&topic.columns) {
        if let (Some((list, _)), Cells::Text(_)) = (split_item(field), cells)
            && is_of_names(list)
            && !found.iter().any(|known| known == list)
        {
            found.push(list.to_owned());
        }
    }
    found
}

fn is_of_names(list: &str) -> bool {
    let last = list.rsplit('.').next().unwrap_or(list);
    matches!(last, "name" | "names") || last.ends_with("_names")
}

/// Columns of a list, by place; none where a place has no column.
fn columns(topic: &Topic, list: &str) -> Vec<Option<usize>> {
    let mut found = Vec::new();
    for (at, field) in topic.fields.iter().enumerate() {
        let place = split_item(field).filter(|(of, _)| *of == list).and_then(|(_, item)| item.parse::<usize>().ok());
        if let Some(place) = place.filter(|&place| place < MAX_ITEMS) {
            found.resize(found.len().max(place + 1), None);
            found[place] = Some(at);
        }
    }
    found
}

/// The lists that the names belong to, with their columns: those beside the list of names that are not longer. A list
/// such as `joint_names` also names those as long as itself in the messages beside it, such as `actual.positions`.
fn parallel(topic: &Topic, names: &str, count: usize) -> BTreeMap<String, Vec<Option<usize>>> {
    let prefix = names.rfind('.').map_or("", |dot| &names[..=dot]);
    let reaches = names.ends_with("_names");
    let mut found = BTreeMap::new();
    for field in &topic.fields {
        let Some((list, _)) = split_item(field) else { continue };
        let Some(rest) = list.strip_prefix(prefix).filter(|_| !is_of_names(list)) else { continue };
        let is_beside = !rest.contains(['.', '[']);
        if found.contains_key(list) || !(is_beside || reaches && !rest.contains('[')) {
            continue;
        }
        let columns = columns(topic, list);
        let fits = if is_beside { columns.len() <= count } else { columns.len() == count };
        if fits && !columns.is_empty() {
            found.insert(list.to_owned(), columns);
        }
    }
    found
}

/// The names in every message.
struct Order {
    names: Vec<String>,
    /// Number of the name at each place; none where a message lists fewer.
    kinds: Vec<Vec<Option<usize>>>,
    /// Number of the kind of every row.
    rows: Vec<usize>,
}

impl Order {
    /// None where names do not tell the items apart: twice in one message, or an item without one.
    fn of(topic: &Topic, names: &[Option<usize>], lists: &BTreeMap<String, Vec<Option<usize>>>) -> Option<Self> {
        let texts: Vec<Option<&Labels>> = names
            .iter()
            .map(|at| match &topic.columns[(*at)?] {
                Cells::Text(texts) => Some(texts),
                Cells::Numbers(_) => None,
            })
            .collect();
        let text = |place: usize, row: usize| texts[place].map_or("", |t| &t[row]);
        let mut order = Self { names: Vec::new(), kinds: Vec::new(), rows: Vec::new() };
        let (mut numbers, mut known) = (HashMap::new(), HashMap::new());
        for row in 0..topic.log_ns.len() {
            let as_before = row > 0 && (0..names.len()).all(|place| text(place, row) == text(place, row - 1));
            if let (true, Some(&before)) = (as_before, order.rows.last()) {
                order.rows.push(before);
                continue;
            }
            let kind: Vec<Option<usize>> = (0..names.len())
                .map(|place| Some(text(place, row)).filter(|name| !name.is_empty()))
                .map(|name| {
                    let next = numbers.len();
                    name.map(|name| *numbers.entry(name.to_owned()).or_insert(next))
                })
                .collect();
            let mut seen = HashSet::new();
            if kind.iter().flatten().any(|name| !seen.insert(*name)) || numbers.len() > MAX_ITEMS {
                return None;
            }
            let next = known.len();
            order.rows.push(*known.entry(kind).or_insert(next));
        }
        order.names = sorted(numbers);
        order.kinds = sorted(known);
        let bytes = 8 * order.names.len() * lists.len() * order.rows.len();
        let fits = order.names.len() <= names.len() || bytes <= NAMED_BYTES;
        (fits && !order.names.is_empty() && order.all_named(topic, lists)).then_some(order)
    }

    fn all_named(&self, topic: &Topic, lists: &BTreeMap<String, Vec<Option<usize>>>) -> bool {
        let nameless = |place: usize, row: usize| self.kinds[self.rows[row]].get(place).copied().flatten().is_none();
        lists.values().all(|columns| {
            columns.iter().enumerate().filter_map(|(place, at)| Some((place, &topic.columns[(*at)?]))).all(
                |(place, cells)| {
                    let partly = self.kinds.iter().any(|kind| kind.get(place).copied().flatten().is_none());
                    !partly || (0..cells.len()).all(|row| !nameless(place, row) || is_empty(cells, row))
                },
            )
        })
    }

    /// A sentence if a name moves from one place to another.
    fn moves(&self, list: &str) -> Option<String> {
        let mut last: Vec<Option<usize>> = vec![None; self.names.len()];
        let (mut moves, mut first) = (0_usize, 0);
        for (row, &kind) in self.rows.iter().enumerate().filter(|&(row, kind)| row == 0 || self.rows[row - 1] != *kind)
        {
            let mut moved = false;
            for (place, name) in self.kinds[kind].iter().enumerate().filter_map(|(p, n)| Some((p, (*n)?))) {
                moved |= last[name].replace(place).is_some_and(|before| before != place);
            }
            if moved && moves == 0 {
                first = row + 1;
            }
            moves += usize::from(moved);
        }
        let times = if moves == 1 { "once".to_owned() } else { format!("{moves} times") };
        (moves > 0).then(|| {
            format!("the names in `{list}` change their order {times}, first in message {first}; every item is read by its name")
        })
    }

    fn places(&self, lists: &BTreeMap<String, Vec<Option<usize>>>) -> Vec<Place> {
        let mut places = Vec::new();
        for (list, columns) in lists {
            for place in 0..columns.len() {
                let mut names: Vec<usize> =
                    self.kinds.iter().filter_map(|kind| kind.get(place).copied().flatten()).collect();
                names.sort_unstable();
                names.dedup();
                let named = names.iter().map(|&name| format!("{list}[{}]", self.names[name])).collect();
                places.push(Place { field: format!("{list}[{place}]"), named });
            }
        }
        places
    }

    /// The column of one name, from the columns by place.
    fn column(&self, name: usize, by_place: &[Option<&Cells>]) -> Cells {
        let place_in = |kind: &Vec<Option<usize>>| kind.iter().position(|n| *n == Some(name));
        let place: Vec<Option<usize>> = self.kinds.iter().map(place_in).collect();
        let cells = |row: usize| by_place.get(place[self.rows[row]]?).copied().flatten();
        let rows = 0..self.rows.len();
        if by_place.iter().flatten().any(|cells| matches!(cells, Cells::Text(_))) {
            return Cells::Text(rows.map(|row| cells(row).map_or(String::new(), |c| c.text(row))).collect());
        }
        let number = |row: usize| match cells(row) {
            Some(Cells::Numbers(values)) => values[row],
            _ => MISSING,
        };
        Cells::Numbers(rows.map(number).collect())
    }
}

fn is_empty(cells: &Cells, row: usize) -> bool {
    match cells {
        Cells::Numbers(values) => is_missing(values[row]),
        Cells::Text(texts) => texts[row].is_empty(),
    }
}

/// The keys in the order of their numbers.
fn sorted<K>(numbers: HashMap<K, usize>) -> Vec<K> {
    let mut pairs: Vec<(K, usize)> = numbers.into_iter().collect();
    pairs.sort_by_key(|(_, number)| *number);
    pairs.into_iter().map(|(key, _)| key).collect()
}

/// Puts columns by name in place of those by place, and takes the names themselves out.
fn rename(topic: &mut Topic, names: &str, order: &Order, lists: &BTreeMap<String, Vec<Option<usize>>>) {
    let mut made: HashMap<&str, Vec<(String, Cells)>> = HashMap::new();
    for (list, columns) in lists {
        let by_place: Vec<Option<&Cells>> = columns.iter().map(|at| Some(&topic.columns[(*at)?])).collect();
        let listed =
            |name: usize| order.kinds.iter().any(|kind| kind.iter().take(columns.len()).any(|n| *n == Some(name)));
        let column = |name: usize| (format!("{list}[{}]", order.names[name]), order.column(name, &by_place));
        made.insert(list, (0..order.names.len()).filter(|&name| listed(name)).map(column).collect());
    }
    let mut all: Vec<(String, Cells)> = Vec::with_capacity(topic.fields.len());
    for (field, cells) in std::mem::take(&mut topic.fields).into_iter().zip(std::mem::take(&mut topic.columns)) {
        match split_item(&field).map(|(list, _)| list) {
            Some(list) if list == names => {}
            // All at the place of the first item.
            Some(list) if lists.contains_key(list) => all.extend(made.remove(list).unwrap_or_default()),
            _ => all.push((field, cells)),
        }
    }
    topic.replace(all);
}

#[cfg(test)]
mod tests {
    use super::super::topic::tests::topic;
    use super::*;

    const ROW: &[(&str, &str)] =
        &[("name[0]", "hip"), ("name[1]", "knee"), ("position[0]", "1"), ("position[1]", "2"), ("mode[0]", "on")];

    fn texts(topic: &Topic, field: &str) -> Vec<String> {
        let cells = topic.find(field).unwrap_or_else(|| panic!("{field} in {:?}", topic.fields));
        (0..cells.len()).map(|row| cells.text(row)).collect()
    }

    #[test]
    fn lists_beside_names_are_named_after_them() {
        let mut topic = topic(&[ROW, ROW]);
        let mut said = Vec::new();
        let places = name_items(&mut topic, &mut said);
        assert_eq!(topic.fields, ["position[hip]", "position[knee]", "mode[hip]"]);
        assert!(said.is_empty(), "{said:?}");
        assert!(places.contains(&Place { field: "position[1]".to_owned(), named: vec!["position[knee]".to_owned()] }));
    }

    #[test]
    fn an_item_follows_its_name_to_another_place() {
        let swapped: &[(&str, &str)] =
            &[("name[0]", "knee"), ("name[1]", "hip"), ("position[0]", "4"), ("position[1]", "3"), ("mode[0]", "off")];
        let mut topic = topic(&[ROW, swapped, ROW]);
        let mut said = Vec::new();
        let places = name_items(&mut topic, &mut said);
        assert_eq!(texts(&topic, "position[hip]"), ["1", "3", "1"]);
        assert_eq!(texts(&topic, "position[knee]"), ["2", "4", "2"]);
        assert_eq!(texts(&topic, "mode[knee]"), ["", "off", ""]);
        assert!(said.len() == 1 && said[0].contains("2 times, first in message 2"), "{said:?}");
        assert!(places.iter().any(|p| p.field == "position[0]" && p.named.len() == 2), "{places:?}");
    }

    #[test]
    fn names_that_do_not_tell_items_apart_name_nothing() {
        let twice: &[(&str, &str)] = &[("name[0]", "knee"), ("name[1]", "knee"), ("position[0]", "4")];
        let without: &[(&str, &str)] = &[("position[0]", "4"), ("position[1]", "3")];
        for rows in [[ROW, twice], [ROW, without]] {
            let mut topic = topic(&rows);
            assert!(name_items(&mut topic, &mut Vec::new()).is_empty());
            assert!(topic.fields.contains(&"position[0]".to_owned()), "{:?}", topic.fields);
        }
    }

    #[test]
    fn names_of_joints_reach_into_the_messages_beside_them() {
        let row: &[(&str, &str)] = &[
            ("joint_names[0]", "hip"),
            ("joint_names[1]", "knee"),
            ("actual.positions[0]", "1"),
            ("actual.positions[1]", "2"),
            ("actual.other[0]", "7"),
        ];
        let mut topic = topic(&[row, row]);
        name_items(&mut topic, &mut Vec::new());
        assert_eq!(topic.fields, ["actual.positions[hip]", "actual.positions[knee]", "actual.other[0]"]);
    }
}
