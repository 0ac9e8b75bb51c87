//! The rows of a table as CSV. A row is what it is in JSON, its nested objects laid flat, so that the
//! two cannot disagree.

use serde::Serialize;
use serde_json::Value;

/// A line of names and a line for each row. `{"error": {"max": 1}}` becomes a column `error.max`.
pub fn table(rows: &[impl Serialize]) -> serde_json::Result<String> {
    let mut text = String::new();
    for (number, row) in rows.iter().enumerate() {
        let mut cells = Vec::new();
        flatten(String::new(), &serde_json::to_value(row)?, &mut cells);
        let line = |cells: Vec<&str>| cells.join(",") + "\n";
        if number == 0 {
            text += &line(cells.iter().map(|(name, _)| name.as_str()).collect());
        }
        text += &line(cells.iter().map(|(_, cell)| cell.as_str()).collect());
    }
    Ok(text)
}

fn flatten(name: String, value: &Value, cells: &mut Vec<(String, String)>) {
    match value {
        Value::Object(members) => {
            for (key, value) in members {
                let name = if name.is_empty() { key.clone() } else { format!("{name}.{key}") };
                flatten(name, value, cells);
            }
        }
        Value::Null => cells.push((name, String::new())),
        Value::String(text) => cells.push((name, quoted(text))),
        other => cells.push((name, other.to_string())),
    }
}

/// In quotes where it would be taken for more than one cell (RFC 4180).
fn quoted(text: &str) -> String {
    match text.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn nested_objects_are_columns() {
        let rows = [
            json!({"name": "a, \"b\"", "error": {"max": 0.5, "mean": null}, "frames": 3}),
            json!({"name": "c", "error": {"max": 1e-7, "mean": 2}, "frames": 4}),
        ];
        let expected = "name,error.max,error.mean,frames\n\"a, \"\"b\"\"\",0.5,,3\nc,1e-7,2,4\n";
        assert_eq!(table(&rows).unwrap(), expected);
    }
}
