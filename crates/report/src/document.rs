//! The frame of every page: head, content policy, style, data, plotly.js, script.

use crate::packed;
use crate::text;

const STYLE: &str = include_str!("assets/page.css");
/// The script that unpacks plotly.js and the data, sets the dark or light theme, and shows a
/// message if the browser lacks a feature.
const START: &str = include_str!("assets/start.js");

/// The content policy: the page may not fetch anything. All code is inline; `unsafe-eval` is needed
/// because plotly.js compiles code.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline' 'unsafe-eval'; \
                      style-src 'unsafe-inline'; img-src data: blob:";

/// Scripts of a page, run in this order after its body.
pub(crate) struct Scripts<'a> {
    /// JSON by element id; scripts read it with `data(id)`.
    pub(crate) data: Vec<(String, String)>,
    /// The page's script, run after plotly.js and the data are unpacked.
    pub(crate) code: &'a str,
}

/// Assembles a page; `body` is HTML, `title` is plain text.
///
/// plotly.js is embedded once, compressed; a page without scripts does not have it.
pub(crate) fn document(title: &str, body: &str, scripts: Option<Scripts<'_>>) -> String {
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n{body}",
        text::html(title)
    );
    if let Some(scripts) = scripts {
        for (id, json) in &scripts.data {
            out += &format!(
                "<script type=\"text/plain\" class=\"packed\" id=\"{}\">{}</script>\n",
                text::html(id),
                packed::deflated(json)
            );
        }
        out += "<script type=\"text/plain\" id=\"plotly-js\">";
        out += packed::PLOTLY;
        out += "</script>\n<script>\n";
        out += START;
        out += "start(function (data) {\n";
        out += scripts.code;
        out += "});\n</script>\n";
    }
    out += "</body>\n</html>\n";
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_without_scripts_is_small() {
        let html = document("<t>", "<p>a</p>\n", None);
        assert!(html.len() < 20_000);
        assert!(html.contains("<title>&lt;t&gt;</title>"));
    }
}
