//! `iso engines`: the interpreter against native code.

use crate::harness::Case;

#[test]
fn tables_and_plots_are_written_for_every_size() {
    let case = Case::new();
    let sizes = ["engines", "--sizes", "3,60", "--sides", "16,32", "--runs", "2", "-o", "out"];
    case.run(&sizes).exits(0).prints("out/evaluations.csv\nout/pictures.csv\n");
    for (name, rows) in [("evaluations", 4), ("pictures", 8)] {
        let content = case.content(&format!("out/{name}.csv"));
        let mut table = csv::Reader::from_reader(&content[..]);
        let head = table.headers().unwrap().clone();
        let records: Vec<csv::StringRecord> = table.records().map(Result::unwrap).collect();
        assert_eq!(records.len(), rows, "two families of two formulas");
        let first_figure = head.iter().position(|column| column.starts_with("interp_")).unwrap();
        for record in &records {
            assert!(
                record.iter().skip(first_figure).all(|figure| figure.parse::<f64>().unwrap() > 0.0),
                "{record:?}"
            );
        }
    }
    for family in ["blobs", "balls"] {
        for plot in ["evaluations", "pictures"] {
            let text = String::from_utf8(case.content(&format!("out/{plot}-{family}.svg"))).unwrap();
            roxmltree::Document::parse(&text).unwrap();
            assert!(text.matches("class=\"mark\"").count() >= 4 && !text.contains("NaN"), "{text}");
        }
    }
}

#[test]
fn what_takes_too_long_is_left_out() {
    let case = Case::new();
    let flags =
        ["--families", "balls", "--sizes", "10", "--sides", "16,32", "--patience", "1ms", "--runs", "1"];
    case.run(&[&["engines", "-o", "out"], &flags[..]].concat()).exits(0);
    let content = String::from_utf8(case.content("out/pictures.csv")).unwrap();
    assert_eq!(content.lines().count(), 2, "{content}");
}
