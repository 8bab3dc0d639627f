//! The frame of every page: head, policy, style, plotly.js, data, script.

use plotly::Plot;

use crate::text;

const STYLE: &str = include_str!("assets/page.css");

/// Nothing may be fetched from anywhere: a browser that honours this cannot even try.
/// Inline code is all there is; `unsafe-eval` since plotly.js compiles some of its own.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline' 'unsafe-eval'; \
                      style-src 'unsafe-inline'; img-src data: blob:";

/// Scripts of a page, run in this order after its body.
pub(crate) struct Scripts<'a> {
    /// JSON by element id, readable through `textContent`.
    pub(crate) data: Vec<(String, String)>,
    /// Our own script.
    pub(crate) code: &'a str,
}

/// Assembles a page; `body` is HTML, `title` is plain text.
///
/// plotly.js is embedded once, and not at all without scripts.
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
                "<script type=\"application/json\" id=\"{}\">{}</script>\n",
                text::html(id),
                text::json_in_script(json)
            );
        }
        out += "<script>";
        out += plotly_js(&Plot::offline_js_sources());
        out += "</script>\n<script>\n";
        out += scripts.code;
        out += "</script>\n";
    }
    out += "</body>\n</html>\n";
    out
}

/// The source of plotly.js among the embedded scripts.
///
/// It is the first of them; the formula renderer that follows is a third of the size, and
/// no page here has formulas.
fn plotly_js(sources: &str) -> &str {
    let start = sources.find('>').map_or(0, |tag_end| tag_end + 1);
    let end = sources.find("</script>").unwrap_or(sources.len());
    &sources[start..end]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_embedded_script_is_plotly() {
        let sources = Plot::offline_js_sources();
        let js = plotly_js(&sources);
        assert!(js.trim_start().starts_with("/**\n* plotly.js v3"));
        assert!(js.len() > 4_000_000 && js.len() < 5_000_000);
    }

    #[test]
    fn a_page_without_scripts_is_small() {
        let html = document("<t>", "<p>a</p>\n", None);
        assert!(html.len() < 20_000);
        assert!(html.contains("<title>&lt;t&gt;</title>"));
    }
}
