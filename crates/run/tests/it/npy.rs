//! `.npy` files of several programs.

use run::npy::{NpyError, Table};

/// A file with this header and data.
fn file(version: u8, header: &str, data: &[u8]) -> Vec<u8> {
    let mut bytes = b"\x93NUMPY".to_vec();
    bytes.extend_from_slice(&[version, 0]);
    match version {
        1 => bytes.extend_from_slice(&(header.len() as u16).to_le_bytes()),
        _ => bytes.extend_from_slice(&(header.len() as u32).to_le_bytes()),
    }
    bytes.extend_from_slice(header.as_bytes());
    bytes.extend_from_slice(data);
    bytes
}

fn doubles(values: &[f64]) -> Vec<u8> {
    values.iter().flat_map(|v| v.to_le_bytes()).collect()
}

#[test]
fn a_table_reads_back_to_the_last_bit() {
    let values = [
        0.1,
        -0.0,
        f64::MAX,
        f64::MIN_POSITIVE,
        f64::INFINITY,
        1.0 / 3.0,
    ];
    let table = Table::new(2, values.to_vec()).unwrap();
    let bytes = table.to_npy();
    assert_eq!((bytes.len() - 48) % 64, 0);
    let read = Table::from_npy(&bytes).unwrap();
    assert_eq!((read.columns(), read.row_count()), (2, 3));
    let bits = |t: &Table| -> Vec<u64> { t.rows().flatten().map(|v| v.to_bits()).collect() };
    assert_eq!(bits(&read), bits(&table));
    assert_eq!(Table::new(4, values.to_vec()), None);
    assert_eq!(Table::new(0, Vec::new()), None);
}

#[test]
fn both_orders_both_widths_and_all_versions_are_read() {
    let expected = Table::new(3, vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]).unwrap();
    let plain = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }\n";
    for version in 1..=3 {
        let bytes = file(version, plain, &doubles(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]));
        assert_eq!(Table::from_npy(&bytes), Ok(expected.clone()));
    }
    let fortran = "{\"shape\": (2L,3L), \"fortran_order\":True, \"descr\" : \"<f8\"}";
    let bytes = file(1, fortran, &doubles(&[1.0, 4.0, 2.0, 5.0, 3.0, 6.0]));
    assert_eq!(Table::from_npy(&bytes), Ok(expected.clone()));
    let single = plain.replace("<f8", ">f4");
    let data: Vec<u8> = (1..=6_u8)
        .flat_map(|v| f32::from(v).to_be_bytes())
        .collect();
    assert_eq!(Table::from_npy(&file(1, &single, &data)), Ok(expected));
}

#[test]
fn what_is_wrong_is_named() {
    assert_eq!(Table::from_npy(b"ply\n"), Err(NpyError::Magic));
    assert_eq!(
        Table::from_npy(&file(9, "", b"")),
        Err(NpyError::Version { major: 9 })
    );
    let good = file(
        1,
        "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }",
        &doubles(&[0.0; 6]),
    );
    for end in [7, 9, 30, good.len() - 1] {
        let error = Table::from_npy(&good[..end]).unwrap_err();
        assert!(matches!(error, NpyError::Length { found, .. } if found == end));
    }
    let shape = Table::from_npy_with_columns(&good, 21).unwrap_err();
    assert_eq!(shape.to_string(), "an array of shape [2, 3]; expected N×21");
    for (header, key) in [
        (
            "{'descr': '<i8', 'fortran_order': False, 'shape': (2, 3)}",
            "descr",
        ),
        (
            "{'descr': '<f8', 'fortran_order': maybe, 'shape': (2, 3)}",
            "fortran_order",
        ),
        (
            "{'descr': '<f8', 'fortran_order': False, 'shape': (2, x)}",
            "shape",
        ),
        ("{'descr': '<f8', 'fortran_order': False}", "shape"),
    ] {
        let error = Table::from_npy(&file(1, header, b"")).unwrap_err();
        assert!(
            matches!(error, NpyError::Header { key: k, .. } if k == key),
            "{error}"
        );
    }
    for shape in ["(6,)", "()", "(1, 2, 3)", "(2, 0)"] {
        let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}}}");
        let error = Table::from_npy(&file(1, &header, &doubles(&[0.0; 6]))).unwrap_err();
        assert!(matches!(error, NpyError::Shape { .. }), "{error}");
    }
    // The product of these overflows 64 bits.
    let huge = "{'descr': '<f8', 'fortran_order': False, 'shape': (18446744073709551615, 18446744073709551615)}";
    let error = Table::from_npy(&file(1, huge, b"")).unwrap_err();
    assert!(matches!(error, NpyError::Length { .. }), "{error}");
}

#[test]
fn nested_types_are_refused_at_once() {
    let nested = format!("{}{}", "[('a', ".repeat(300), ")]".repeat(300));
    let header = format!("{{'descr': {nested}, 'fortran_order': False, 'shape': (1, 1)}}");
    let error = Table::from_npy(&file(1, &header, b"")).unwrap_err();
    assert!(
        matches!(error, NpyError::Header { key: "descr", .. }),
        "{error}"
    );
    let long = "[".repeat(50_000);
    let error = Table::from_npy(&file(1, &long, b"")).unwrap_err();
    assert!(matches!(error, NpyError::Header { .. }), "{error}");
}
