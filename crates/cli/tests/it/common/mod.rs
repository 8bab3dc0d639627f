//! Running the program, and what it says; no test file needs all of it.
#![allow(dead_code)]

use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};

/// Runs the program in a folder.
pub(crate) fn moduli(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_moduli"))
        .current_dir(folder)
        .args(arguments)
        .output()
        .expect("the program starts")
}

/// Runs the program with bytes on its standard input.
pub(crate) fn moduli_fed(folder: &Path, arguments: &[&str], input: &[u8]) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_moduli"))
        .current_dir(folder)
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let mut pipe = child.stdin.take().expect("its input is a pipe");
    pipe.write_all(input).expect("it reads its input");
    drop(pipe);
    child.wait_with_output().expect("it ends")
}

/// What it said; it must have succeeded.
pub(crate) fn stdout(output: &Output) -> String {
    assert!(
        output.status.success(),
        "exit {:?}: {}",
        output.status.code(),
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8(output.stdout.clone()).unwrap()
}

/// It must have failed with this code and these words, without a panic.
pub(crate) fn refused(output: &Output, code: i32, words: &[&str]) {
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{said}");
    for word in words {
        assert!(said.contains(word), "`{word}` is not in: {said}");
    }
    assert!(!said.contains("panicked"), "{said}");
}

/// Fits an ellipsoid of these half axes about a centre: NAME.xyz and NAME.shape.
pub(crate) fn fitted(folder: &Path, name: &str, axes: [f64; 3], centre: [f64; 3]) {
    let text: String = sph::direction::even_directions(1200)
        .iter()
        .map(|p| {
            let at = |k: usize| centre[k] + axes[k] * p[k];
            format!("{} {} {}\n", at(0), at(1), at(2))
        })
        .collect();
    std::fs::write(folder.join(format!("{name}.xyz")), text).unwrap();
    let (cloud, shape) = (format!("{name}.xyz"), format!("{name}.shape"));
    stdout(&moduli(
        folder,
        &["fit", &cloud, "--degree", "8", "-o", &shape, "-q"],
    ));
}

/// A table as the bytes of a `.npy` file.
pub(crate) fn npy(columns: usize, values: &[f64]) -> Vec<u8> {
    use npyz::WriterBuilder;
    let mut bytes = Vec::new();
    let mut writer = npyz::WriteOptions::new()
        .default_dtype()
        .shape(&[(values.len() / columns) as u64, columns as u64])
        .writer(&mut bytes)
        .begin_nd()
        .unwrap();
    writer.extend(values.iter().copied()).unwrap();
    writer.finish().unwrap();
    bytes
}

/// The numbers of a `.npy` file with so many columns.
pub(crate) fn read_npy(path: &Path, columns: u64) -> Vec<f64> {
    let bytes = std::fs::read(path).unwrap();
    let file = npyz::NpyFile::new(&bytes[..]).unwrap();
    assert_eq!(file.shape()[1], columns);
    file.into_vec::<f64>().unwrap()
}
