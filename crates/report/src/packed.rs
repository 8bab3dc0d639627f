//! Data of a page in little room: numbers as bytes, text deflated, both as base64.

use std::io::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use serde_json::{Value, json};

/// Lists of at least this many numbers are packed.
const WORTH_PACKING: usize = 64;

/// plotly.js, deflated (zlib) and in base64.
pub(crate) const PLOTLY: &str = include_str!(concat!(env!("OUT_DIR"), "/plotly.js.zlib.base64"));

/// Text, deflated (zlib) and in base64; the browser unpacks it by its own `DecompressionStream`.
pub(crate) fn deflated(text: &str) -> String {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
    // Writing to memory does not fail.
    let written = encoder.write_all(text.as_bytes());
    let bytes = written.and_then(|()| encoder.finish()).unwrap_or_default();
    STANDARD.encode(bytes)
}

/// What the plotly crate writes, as a value.
pub(crate) fn figure_value(json: &str) -> Value {
    // The plotly crate writes JSON; anything else would be seen as an empty figure.
    serde_json::from_str(json).unwrap_or(Value::Null)
}

/// Prepares a figure of plotly.js: sets the light of its meshes, and packs long lists of coordinates
/// as 32-bit floats and of vertex indices as integers of 16 bits where these suffice,
/// little endian.
///
/// plotly.js reads such lists in the form {dtype, bdata}. The light stands over the viewer's left
/// shoulder, whichever way the object is turned: plotly.js takes its position in coordinates of the
/// screen (right, up, and depth with −1 at the near plane), so that one place in space has other
/// numbers in a `flat` (parallel) view.
pub(crate) fn prepare(value: &mut Value, flat: bool) {
    match value {
        Value::Array(list) => list.iter_mut().for_each(|v| prepare(v, flat)),
        Value::Object(object) => {
            if object.get("type").is_some_and(|t| t == "mesh3d") {
                let light = if flat { [-4, 6, -8] } else { [-12, 18, -1] };
                let [x, y, z] = light;
                object.insert(
                    "lightposition".to_owned(),
                    json!({ "x": x, "y": y, "z": z }),
                );
                for key in ["i", "j", "k"] {
                    let narrow = |v: &Value| Some(u16::try_from(v.as_u64()?).ok()?.to_le_bytes());
                    let wide = |v: &Value| Some(u32::try_from(v.as_u64()?).ok()?.to_le_bytes());
                    if !pack(object.get_mut(key), "u2", narrow) {
                        pack(object.get_mut(key), "u4", wide);
                    }
                }
            }
            if object
                .get("type")
                .is_some_and(|t| t == "mesh3d" || t == "scatter3d")
            {
                for key in ["x", "y", "z"] {
                    pack(object.get_mut(key), "f4", |v| {
                        Some((v.as_f64()? as f32).to_le_bytes())
                    });
                }
            }
            object.values_mut().for_each(|v| prepare(v, flat));
        }
        _ => {}
    }
}

/// Packs a list of numbers if it is long, and if `bytes` knows every entry; whether it did.
fn pack<const N: usize>(
    list: Option<&mut Value>,
    kind: &str,
    bytes: impl Fn(&Value) -> Option<[u8; N]>,
) -> bool {
    let Some(list) = list else { return false };
    let Some(entries) = list.as_array().filter(|l| l.len() >= WORTH_PACKING) else {
        return false;
    };
    let packed: Option<Vec<[u8; N]>> = entries.iter().map(bytes).collect();
    let Some(packed) = packed else { return false };
    *list = json!({ "dtype": kind, "bdata": STANDARD.encode(packed.as_flattened()) });
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::read::ZlibDecoder;
    use std::io::Read;

    fn inflated(text: &str) -> String {
        let bytes = STANDARD.decode(text).unwrap();
        let mut out = String::new();
        ZlibDecoder::new(&bytes[..])
            .read_to_string(&mut out)
            .unwrap();
        out
    }

    #[test]
    fn the_script_is_plotly_and_less_than_half_as_large() {
        let script = inflated(PLOTLY);
        assert!(script.starts_with("/**\n* plotly.js v3"));
        assert!(script.len() > 4_000_000 && !script.contains("</script>"));
        assert!(2 * PLOTLY.len() < script.len(), "{}", PLOTLY.len());
    }

    #[test]
    fn text_comes_back() {
        let text = "äöü <script> ".repeat(1000);
        let packed = deflated(&text);
        assert!(packed.len() < 500);
        assert_eq!(inflated(&packed), text);
    }

    #[test]
    fn long_lists_are_packed_and_short_ones_are_not() {
        let numbers: Vec<f64> = (0..100).map(|k| 0.5 * f64::from(k)).collect();
        let indices: Vec<u32> = (0..100).collect();
        let mut figure = json!([
            {"type": "mesh3d", "x": numbers, "i": indices, "y": [1.0, 2.0]},
            {"type": "scatter", "x": numbers},
        ]);
        prepare(&mut figure, false);
        assert_eq!(figure[0]["lightposition"]["y"], 18);
        assert_eq!(figure[0]["y"], json!([1.0, 2.0]));
        assert_eq!(figure[1]["x"][99], 49.5);
        let bytes = STANDARD
            .decode(figure[0]["x"]["bdata"].as_str().unwrap())
            .unwrap();
        assert_eq!(bytes[4 * 99..], 49.5_f32.to_le_bytes());
        let bytes = STANDARD
            .decode(figure[0]["i"]["bdata"].as_str().unwrap())
            .unwrap();
        assert_eq!(bytes[2 * 99..], 99_u16.to_le_bytes());
    }
}
