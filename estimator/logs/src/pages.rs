//! Room for long columns in pages of two megabytes, if the system has them. Twelve channels of a million rows take
//! 24 000 ordinary pages, and getting each of them from the system costs as long as parsing a thousand numbers.

/// Columns with room for less are left to ordinary pages: a large page that is half empty is wasted memory.
#[cfg(target_os = "linux")]
const LEAST_BYTES: usize = 4 << 20;

/// Makes room for at least `rows` numbers behind those of `column`, as [`Vec::reserve_exact`] does.
pub fn reserve_exact(column: &mut Vec<f64>, rows: usize) {
    column.reserve_exact(rows);
    #[cfg(target_os = "linux")]
    ask_for_large_pages(column);
}

/// Only advice: a system without large pages refuses, and nothing else is different.
#[cfg(target_os = "linux")]
fn ask_for_large_pages(column: &mut Vec<f64>) {
    let spare = column.spare_capacity_mut();
    let bytes = size_of_val(spare);
    if bytes < LEAST_BYTES {
        return;
    }
    let start = spare.as_mut_ptr().cast::<u8>();
    // Whole pages of the room alone: anything that shares a page with it is not ours.
    let skipped = start.align_offset(PAGE_BYTES);
    if skipped > bytes {
        return;
    }
    let whole = (bytes - skipped) / PAGE_BYTES * PAGE_BYTES;
    // SAFETY: the range lies within memory that the vector owns. The advice changes neither its contents nor its access
    // rights, only the size of the pages behind it.
    #[allow(unsafe_code, reason = "a system call without a safe wrapper among the dependencies")]
    unsafe {
        libc::madvise(start.add(skipped).cast(), whole, libc::MADV_HUGEPAGE)
    };
}

/// Pages are at least so large on every Linux; where they are larger the advice is refused.
#[cfg(target_os = "linux")]
const PAGE_BYTES: usize = 4096;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn room_is_made_behind_what_is_there() {
        for rows in [0, 1, 1000, 3 << 20] {
            let mut column = vec![1.0, 2.0];
            reserve_exact(&mut column, rows);
            assert!(column.capacity() >= rows + 2);
            column.extend((0..rows).map(|n| n as f64));
            assert_eq!((column[1], column.len()), (2.0, rows + 2));
            assert!(column[2..].iter().zip(0_u32..).all(|(&is, n)| is == f64::from(n)));
        }
    }
}
