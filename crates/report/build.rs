//! Compresses the plotly.js of the plotly crate for embedding in pages.

use std::error::Error;
use std::io::Write;
use std::path::PathBuf;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=build.rs");
    let scripts = plotly::Plot::offline_js_sources();
    // The crate returns its scripts as HTML elements: plotly.js first, then a formula renderer,
    // which no page uses.
    let start = scripts
        .find("/**\n* plotly.js v3")
        .ok_or("no plotly.js in the plotly crate")?;
    let length = scripts[start..]
        .find("</script>")
        .ok_or("plotly.js does not end")?;
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(&scripts.as_bytes()[start..start + length])?;
    let target = PathBuf::from(std::env::var("OUT_DIR")?).join("plotly.js.zlib.base64");
    std::fs::write(target, STANDARD.encode(encoder.finish()?))?;
    Ok(())
}
