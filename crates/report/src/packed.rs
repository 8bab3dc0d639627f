//! Compact data of a page: text, deflated and in base64.
//!
//! Coordinates stay decimal numbers: rounded to 0.02 mm they deflate to less room than their bytes do.

use std::io::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use serde_json::{Value, json};

/// plotly.js, deflated (zlib) and in base64.
pub(crate) const PLOTLY: &str = include_str!(concat!(env!("OUT_DIR"), "/plotly.js.zlib.base64"));

/// Text, deflated (zlib) and in base64; the browser unpacks it with `DecompressionStream`.
pub(crate) fn deflated(text: &str) -> String {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
    // Writing to memory cannot fail.
    let written = encoder.write_all(text.as_bytes());
    let bytes = written.and_then(|()| encoder.finish()).unwrap_or_default();
    STANDARD.encode(bytes)
}

/// The JSON of the plotly crate, parsed.
pub(crate) fn figure_value(json: &str) -> Value {
    // The plotly crate writes valid JSON; anything else would show as an empty figure.
    serde_json::from_str(json).unwrap_or(Value::Null)
}

/// Sets the light of all meshes of a figure: over the viewer's left shoulder, for every orientation
/// of the object.
///
/// plotly.js takes the light's position in screen coordinates (right, up, and depth with −1 at the
/// near plane). The same position in space therefore has other coordinates in a `flat` (parallel)
/// view.
pub(crate) fn set_light(value: &mut Value, flat: bool) {
    match value {
        Value::Array(list) => list.iter_mut().for_each(|v| set_light(v, flat)),
        Value::Object(object) => {
            if object.get("type").is_some_and(|t| t == "mesh3d") {
                let [x, y, z] = if flat { [-4, 6, -8] } else { [-12, 18, -1] };
                let light = json!({ "x": x, "y": y, "z": z });
                object.insert("lightposition".to_owned(), light);
            }
            object.values_mut().for_each(|v| set_light(v, flat));
        }
        _ => {}
    }
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
    fn every_mesh_has_a_light() {
        let mut figure = json!({"data": [{"type": "mesh3d", "x": [1.0]}, {"type": "scatter"}]});
        set_light(&mut figure, false);
        assert_eq!(figure["data"][0]["lightposition"]["y"], 18);
        assert!(figure["data"][1]["lightposition"].is_null());
    }
}
