//! The original's tables of measured infrared sensors: `.sam`.
#![no_main]

use farsa_body::sensors::infrared::{InfraredTable, InfraredTables};
use farsa_fuzz::bounded;
use libfuzzer_sys::fuzz_target;

farsa_fuzz::text!();

fuzz_target!(|input: &[u8]| {
    let Ok(text) = std::str::from_utf8(input) else { return };
    let Ok(table) = bounded(input.len(), || InfraredTable::parse(text)) else { return };
    let (range, sensors) = (table.range(), table.sensors());
    for part in 0..64 {
        let (distance, bearing) = (range * part as f32 / 64.0, part as f32);
        let row = table.response(distance, bearing).expect("within its range");
        assert!(row.len() == sensors && row.iter().all(|reading| (0.0..1.0).contains(reading)));
    }
    assert_eq!(table.response(range + 0.1, 0.0), None);
    let tables = InfraredTables::new(table.clone(), vec![(0.01, table)]).expect("as many sensors");
    assert!((tables.range(), tables.sensors()) == (range, sensors));
});
