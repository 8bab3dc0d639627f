//! Escaping: every text of the caller passes through one of these functions.

/// Escapes text for HTML content and for attribute values in double or single quotes.
pub(crate) fn html(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + 8);
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            _ => out.push(c),
        }
    }
    out
}

/// Plain text for plotly.js, which interprets some markup (`<b>`, `<a href>`, entities, `%{…}` in
/// templates) that must not occur in user text.
///
/// Angle brackets are replaced by `‹ ›`, since text drawn by WebGL has no escape for them. A
/// zero-width space separates `&` and `%` from the text that follows.
pub(crate) fn plot(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + 4);
    for c in text.chars() {
        match c {
            '<' => out.push('‹'),
            '>' => out.push('›'),
            '&' => out.push_str("&\u{200b}"),
            '%' => out.push_str("%\u{200b}"),
            _ => out.push(c),
        }
    }
    out
}

/// Paragraphs of HTML; the text is split at blank lines.
pub(crate) fn paragraphs(text: &str) -> String {
    text.split("\n\n")
        .map(str::trim)
        .filter(|paragraph| !paragraph.is_empty())
        .map(|paragraph| format!("<p>{}</p>\n", html(paragraph)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn html_leaves_no_markup() {
        assert_eq!(
            html(r#"<a href="x" id='y'>&"#),
            "&lt;a href=&quot;x&quot; id=&#39;y&#39;&gt;&amp;"
        );
    }

    #[test]
    fn plot_text_has_no_tag_entity_or_template() {
        let text = plot("<b>a</b> &lt; %{x}");
        assert!(!text.contains('<') && !text.contains("&l") && !text.contains("%{"));
    }

    #[test]
    fn paragraphs_part_at_blank_lines() {
        assert_eq!(paragraphs("a\nb\n\nc\n"), "<p>a\nb</p>\n<p>c</p>\n");
        assert_eq!(paragraphs(""), "");
    }
}
