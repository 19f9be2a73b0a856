//! Decimal mark of a table, told by its cells.

/// Numbers with three digits behind the mark that show thousands: of so many decimals without zeros at their ends, one in a
/// hundred tables has none with fewer digits (0.9⁴⁴ = 0.01).
const SHOW_THOUSANDS: usize = 44;

/// Decimal mark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decimal {
    /// A comma may stand between thousands.
    Point,
    /// A point stands between thousands.
    Comma,
    /// The file shows both, or neither.
    Either,
}

/// Marks in the numbers of one column.
#[derive(Clone, Copy, Debug, Default)]
struct Marks {
    /// Numbers whose mark can only be decimal: with a point, with a comma.
    certain: [usize; 2],
    /// Numbers with three digits behind a point or a comma, as behind thousands.
    groups: [usize; 2],
    /// Whole numbers of at most three digits, and of more.
    whole: [usize; 2],
}

impl Marks {
    fn add(&mut self, cell: &str) {
        let is_digits = |text: &str| text.bytes().all(|b| b.is_ascii_digit());
        let digits = cell.trim_start_matches(['+', '-', '\u{2212}']);
        let Some(at) = digits.rfind(['.', ',']) else {
            if !digits.is_empty() && is_digits(digits) {
                self.whole[usize::from(digits.len() > 3)] += 1;
            }
            return;
        };
        let (before, after) = (&digits[..at], &digits[at + 1..]);
        let decimals = after.split(['e', 'E']).next().unwrap_or(after);
        let mark = usize::from(digits.as_bytes()[at] == b',');
        let mut groups = before.split(['.', ',']);
        let first = groups.next().unwrap_or_default();
        let mut is_long = false;
        let are_groups = groups.all(|group| {
            is_long = true;
            group.len() == 3 && is_digits(group)
        });
        if !is_digits(first) || !are_groups || !is_digits(decimals) {
            return;
        }
        if is_long {
            self.add_groups(first, (before, decimals), mark);
            return;
        }
        // Three digits may be a thousand, but not behind a zero, nor behind more than three others.
        let is_certain = decimals.len() != 3 || first.starts_with('0') || !(1..=3).contains(&first.len());
        let counts = if is_certain { &mut self.certain } else { &mut self.groups };
        counts[mark] += 1;
    }

    /// Adds a number with several marks. The last one is decimal if it is another than those before it; marks that are all
    /// alike stand between thousands.
    fn add_groups(&mut self, first: &str, (before, decimals): (&str, &str), mark: usize) {
        let of = |mark: usize| ['.', ','][mark];
        let between = usize::from(before.contains(of(1)));
        if !(1..=3).contains(&first.len()) || before.contains(of(1 - between)) || between == mark && decimals.len() != 3
        {
            return;
        }
        self.certain[1 - between] += 1;
        self.groups[between] += 1;
    }

    /// The mark that stands between thousands: numbers below a thousand have none, and no other number has another count of digits
    /// behind it.
    fn thousands(&self) -> Option<usize> {
        let is_one = |mark: &usize| self.groups[*mark] >= SHOW_THOUSANDS && self.groups[1 - *mark] == 0;
        let is_plain = self.certain == [0; 2] && self.whole[0] > 0 && self.whole[1] == 0;
        (0..2).find(is_one).filter(|_| is_plain)
    }
}

impl Decimal {
    /// The mark of a table's rows, and true if the other one occurs, too.
    pub fn of<'a>(rows: impl Iterator<Item = &'a [String]>) -> (Self, bool) {
        let mut columns: Vec<Marks> = Vec::new();
        for row in rows {
            columns.resize(columns.len().max(row.len()), Marks::default());
            row.iter().zip(&mut columns).for_each(|(cell, marks)| marks.add(cell));
        }
        let has = |of: &dyn Fn(&Marks) -> bool| columns.iter().any(of);
        let (points, commas) = (has(&|marks| marks.certain[0] > 0), has(&|marks| marks.certain[1] > 0));
        let groups = has(&|marks| marks.groups[0] > 0);
        let thousands = |mark: usize| has(&|marks| marks.thousands() == Some(mark));
        match (points, commas) {
            (false, true) => (Self::Comma, groups),
            (true, false) => (Self::Point, has(&|marks| marks.groups[1] > 0)),
            (false, false) if thousands(0) && !thousands(1) => (Self::Comma, true),
            (false, false) if thousands(1) && !thousands(0) => (Self::Point, true),
            (both, _) => (Self::Either, both),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(rows: &[&[&str]]) -> (Decimal, bool) {
        let rows: Vec<Vec<String>> =
            rows.iter().map(|row| row.iter().map(|cell| (*cell).to_owned()).collect()).collect();
        Decimal::of(rows.iter().map(Vec::as_slice))
    }

    #[test]
    fn the_cells_of_a_file_show_its_decimal_mark() {
        assert_eq!(of(&[&["0,000", "0,051263", "-1.372"]]), (Decimal::Comma, true));
        assert_eq!(of(&[&["0.000", "12"]]), (Decimal::Point, false));
        assert_eq!(of(&[&["0.5", "0,5"]]), (Decimal::Either, true));
        assert_eq!(of(&[&["1.234", "12"]]), (Decimal::Either, false));
        assert_eq!(of(&[&["-33.904,582", "1.234"]]), (Decimal::Comma, true));
        assert_eq!(of(&[&["1,234,567", "12"]]), (Decimal::Point, true));
        // Dates and versions are no numbers.
        assert_eq!(of(&[&["14.03.2026", "1.2.3", "0,5"]]), (Decimal::Comma, false));
    }

    #[test]
    fn whole_numbers_below_a_thousand_show_the_marks_between_thousands() {
        let of = |numbers: &dyn Fn(usize) -> String| {
            let rows: Vec<Vec<String>> = (0..100).map(|k| vec![k.to_string(), numbers(k)]).collect();
            Decimal::of(rows.iter().map(Vec::as_slice))
        };
        let grouped =
            |k: usize, mark: char| if k < 50 { format!("{}", 20 * k) } else { format!("{}{mark}{:03}", k / 30, 9 * k) };
        assert_eq!(of(&|k| grouped(k, '.')), (Decimal::Comma, true));
        assert_eq!(of(&|k| grouped(k, ',')), (Decimal::Point, true));
        // Three decimals everywhere, or zeros cut off at their ends.
        assert_eq!(of(&|k| format!("1.{k:03}")), (Decimal::Either, false));
        assert_eq!(of(&|k| if k % 9 == 0 { "1.2".to_owned() } else { grouped(k, '.') }), (Decimal::Point, false));
    }
}
