//! Natural order of names: `frame_2` before `frame_10`.

use std::cmp::Ordering;

/// Compares two names, runs of digits by their value; equal numbers with fewer leading zeros first.
pub fn compare(a: &str, b: &str) -> Ordering {
    let (mut rest_a, mut rest_b) = (a, b);
    loop {
        let ((text_a, number_a), (text_b, number_b)) = (next(&mut rest_a), next(&mut rest_b));
        let order = text_a.cmp(text_b).then_with(|| value(number_a, number_b));
        if order != Ordering::Equal {
            return order;
        }
        if number_a.is_empty() {
            return a.cmp(b);
        }
    }
}

/// Splits the next run of other characters, and the digits that follow, off the front.
fn next<'a>(rest: &mut &'a str) -> (&'a str, &'a str) {
    let text = rest.find(|c: char| c.is_ascii_digit()).unwrap_or(rest.len());
    let (text, tail) = rest.split_at(text);
    let digits = tail.find(|c: char| !c.is_ascii_digit()).unwrap_or(tail.len());
    let (digits, tail) = tail.split_at(digits);
    *rest = tail;
    (text, digits)
}

/// Compares two runs of digits of any length by their value.
fn value(a: &str, b: &str) -> Ordering {
    let (a, b) = (a.trim_start_matches('0'), b.trim_start_matches('0'));
    a.len().cmp(&b.len()).then_with(|| a.cmp(b))
}

/// A name with its last run of digits cut out: equal for the frames of one series. `None` without digits.
pub fn series(stem: &str) -> Option<(&str, &str)> {
    let end = stem.rfind(|c: char| c.is_ascii_digit())? + 1;
    let start = stem[..end].trim_end_matches(|c: char| c.is_ascii_digit()).len();
    Some((&stem[..start], &stem[end..]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_go_by_value() {
        let mut names = vec!["f_10.vtk", "f_9.vtk", "f_010.vtk", "f_2b.vtk", "f_2.vtk", "e_11.vtk", "f.vtk"];
        names.sort_by(|a, b| compare(a, b));
        assert_eq!(names, ["e_11.vtk", "f.vtk", "f_2.vtk", "f_2b.vtk", "f_9.vtk", "f_010.vtk", "f_10.vtk"]);
        let long = "9".repeat(60);
        assert_eq!(compare(&format!("a{long}"), &format!("a1{long}")), Ordering::Less);
    }

    #[test]
    fn the_order_is_total() {
        let names = ["", "0", "00", "a", "a0", "a0b", "a00b", "a1", "ä1", "1a"];
        for a in names {
            for b in names {
                assert_eq!(compare(a, b), compare(b, a).reverse(), "{a} {b}");
                assert_eq!(compare(a, b) == Ordering::Equal, a == b);
            }
        }
    }

    #[test]
    fn a_series_is_a_name_without_its_last_number() {
        assert_eq!(series("run2_frame_007"), Some(("run2_frame_", "")));
        assert_eq!(series("out3.fluid"), Some(("out", ".fluid")));
        assert_eq!(series("mesh"), None);
    }
}
