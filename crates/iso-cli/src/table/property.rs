//! What holds of any bytes: as a table they are read or refused, and what is read is written so that it reads the same.

use std::path::Path;

use crate::table::{Table, digits, read_from, write_row};

const NAMES: [&str; 2] = ["x", "y"];

/// Reads `bytes` as a table with the columns `x` and `y`.
pub(crate) fn bytes_are_read_or_refused(bytes: &[u8]) {
    let path = Path::new("t.csv");
    let table: Table<2> = match read_from(bytes, path, NAMES) {
        Ok(table) => table,
        Err(error) => {
            let message = error.to_string();
            assert!(message.starts_with("t.csv:") && message.chars().count() < 300, "{message}");
            assert!(!message.contains(char::is_control), "{message:?}");
            return;
        }
    };
    assert!(table.columns.iter().all(|column| column.len() == table.rows()));
    let mut written = Vec::new();
    write_row(&mut written, NAMES).expect("memory can be written");
    for row in 0..table.rows() {
        write_row(&mut written, table.row(row).map(digits)).expect("memory can be written");
    }
    let again = read_from(&*written, path, NAMES).expect("what was written is read");
    let bits = |table: &Table<2>| table.columns.each_ref().map(|column| bits(column));
    assert_eq!(bits(&again), bits(&table));
}

/// The bits, any NaN counting as one.
fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| if value.is_nan() { f64::NAN } else { *value }.to_bits()).collect()
}
