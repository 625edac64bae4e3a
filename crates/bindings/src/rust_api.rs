//! The public Rust interface as a list: declarations and methods, from the pages that rustdoc writes.

use crate::declarations::Result;
use std::fs;
use std::path::Path;

/// First line of the list.
const TITLE: &str = "# The public Rust interface, written by `cargo run -p hbvib-bindings -- rust-api`\n";

/// Kinds of items by the beginnings of their pages.
const KINDS: [&str; 6] = ["constant.", "enum.", "fn.", "struct.", "trait.", "type."];

/// The list of all items of a documented crate, in the order of their pages.
///
/// # Errors
/// A folder that cannot be read or has no items.
pub fn list(folder: &Path) -> Result<String> {
    let failed = |error: std::io::Error| format!("{}: {error}", folder.display());
    let mut pages = Vec::new();
    for entry in fs::read_dir(folder).map_err(failed)? {
        let name = entry.map_err(failed)?.file_name().to_string_lossy().into_owned();
        if KINDS.iter().any(|kind| name.starts_with(kind)) {
            pages.push(name);
        }
    }
    pages.sort();
    if pages.is_empty() {
        return Err(format!("{}: no items of the crate", folder.display()));
    }
    let mut text = String::from(TITLE);
    for page in pages {
        let html = fs::read_to_string(folder.join(&page)).map_err(failed)?;
        text.push('\n');
        text.push_str(&item(&html).ok_or_else(|| format!("{page}: no declaration"))?);
    }
    Ok(text)
}

/// Declaration and methods of one item, a line each; implementations of traits are left out.
fn item(html: &str) -> Option<String> {
    let declaration = between(html, "<pre class=\"rust item-decl\"><code>", "</code></pre>").next()?;
    let mut text = line(declaration) + "\n";
    let own = html.split("id=\"trait-implementations\"").next().unwrap_or(html);
    for header in between(own, "<h4 class=\"code-header\">", "</h4>") {
        let signature = line(header);
        if signature.starts_with("pub ") {
            text.push_str("    ");
            text.push_str(&signature);
            text.push('\n');
        }
    }
    Some(text)
}

/// The parts of a text between two marks.
fn between<'a>(text: &'a str, open: &'a str, close: &'a str) -> impl Iterator<Item = &'a str> {
    text.split(open)
        .skip(1)
        .filter_map(move |part| part.split(close).next())
}

/// HTML as one line of text. The label of a folded list of fields is no text.
fn line(html: &str) -> String {
    let mut text = String::new();
    let mut rest = html;
    while let Some((before, after)) = rest.split_once('<') {
        text += before;
        rest = if after.starts_with("summary") {
            after.split_once("</summary>").map_or("", |(_, after)| after)
        } else {
            after.split_once('>').map_or("", |(_, after)| after)
        };
    }
    text += rest;
    let text = text
        .replace("&lt;", "<")
        .replace("&gt;", ">")
        .replace("&#39;", "'")
        .replace("&quot;", "\"");
    let words: Vec<&str> = text.split_whitespace().collect();
    words.join(" ").replace("&amp;", "&").replace("&nbsp;", " ")
}

#[cfg(test)]
mod tests {
    use super::item;

    #[test]
    fn declarations_and_methods_are_listed_without_those_of_traits() {
        let page = "<pre class=\"rust item-decl\"><code>pub struct A&lt;'a&gt; {<details><summary class=\"x\"><span>Show 1 \
                    field</span></summary>\n    pub x: <a href=\"f\">f64</a>,\n</details>}</code></pre>\
                    <h4 class=\"code-header\">pub fn <a href=\"#b\">b</a>(\n    &amp;self,\n) -&gt; usize</h4>\
                    <h2 id=\"trait-implementations\"></h2><h4 class=\"code-header\">pub fn c()</h4>";
        let expected = "pub struct A<'a> { pub x: f64, }\n    pub fn b( &self, ) -> usize\n";
        assert_eq!(item(page).unwrap(), expected);
    }

    #[test]
    fn a_page_without_a_declaration_is_refused() {
        assert_eq!(item("<h4 class=\"code-header\">pub fn b()</h4>"), None);
    }
}
