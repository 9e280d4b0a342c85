//! A page that needs nothing beside itself: text, tables, charts and pictures in one HTML file, without scripts, for screens of any
//! width and for print.

use super::chart::Figure;
use super::chart::letters::{FAMILY, FONT};
use super::chart::svg::{escape, svg};
use super::pictures::Shot;
use std::fmt::Write;

/// A page in the making.
#[derive(Clone, Debug)]
pub struct Page {
    title: String,
    body: String,
    contents: Vec<(String, String)>,
    figures: usize,
}

/// Style: one column as wide as a chart reads well, tables that scroll on their own, nothing cut apart in print.
const STYLE: &str = "
:root{color-scheme:light}
*{box-sizing:border-box}
body{margin:0 auto;padding:1rem;max-width:62rem;background:#fff;color:#222;font:16px/1.5 system-ui,'Segoe UI',Roboto,'DejaVu Sans',sans-serif}
h1{font-size:1.6rem;line-height:1.2;margin:.5rem 0 1rem}
h2{font-size:1.25rem;margin:2.2rem 0 .6rem;padding-top:.6rem;border-top:1px solid #ccc}
h3{font-size:1.05rem;margin:1.4rem 0 .4rem}
p{margin:.5rem 0;max-width:46rem}
code{font:.9em ui-monospace,'DejaVu Sans Mono',monospace;background:#f3f3f3;padding:.1em .3em;overflow-wrap:anywhere}
nav ul{padding-left:1.2rem;margin:.3rem 0}
a{color:#0072b2}
figure{margin:1rem 0}
figure svg{display:block;width:100%;height:auto;max-width:46rem}
figcaption{font-size:.92rem;color:#444;max-width:46rem;margin-top:.4rem}
.scroll{overflow-x:auto;max-width:100%}
table{border-collapse:collapse;font-size:.88rem;font-variant-numeric:tabular-nums}
th,td{padding:.25rem .6rem;text-align:right;white-space:nowrap;border-bottom:1px solid #e5e5e5}
th{border-bottom:2px solid #888;text-align:right;vertical-align:bottom;white-space:normal;min-width:4.5em}
th:first-child,td:first-child,th.l,td.l{text-align:left}
dl{display:grid;grid-template-columns:max-content 1fr;gap:.15rem 1rem;margin:.5rem 0}
dt{color:#555}
dd{margin:0;overflow-wrap:anywhere}
.shots{display:grid;grid-template-columns:repeat(4,1fr);gap:.8rem;margin:.8rem 0}
.shots:has(:only-child){grid-template-columns:minmax(0,26rem)}
.shots figure{margin:0}
.shots img{display:block;width:100%;height:auto;border:1px solid #ccc}
.shots figcaption{font-size:.85rem}
.note{border-left:4px solid #d55e00;padding:.3rem .8rem;background:#fdf4ee}
@media(max-width:44rem){.shots{grid-template-columns:repeat(2,1fr)}}
@media(max-width:34rem){dl{grid-template-columns:1fr}dt{margin-top:.4rem}body{padding:.8rem}}
@media print{body{max-width:none;font-size:10.5pt}h2{break-after:avoid}figure,.shots figure{break-inside:avoid}.scroll{overflow:visible}th,td{padding:.1rem .3rem;white-space:normal}table{font-size:7.5pt}nav{display:none}}
";

impl Page {
    /// An empty page.
    #[must_use]
    pub fn new(title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            body: String::new(),
            contents: Vec::new(),
            figures: 0,
        }
    }

    /// Begins a chapter, listed in the contents.
    pub fn chapter(&mut self, title: &str) {
        let id = format!("c{}", self.contents.len() + 1);
        let _ = writeln!(self.body, "<h2 id=\"{id}\">{}</h2>", escape(title));
        self.contents.push((id, title.to_owned()));
    }

    /// Begins a part of a chapter.
    pub fn heading(&mut self, title: &str) {
        let _ = writeln!(self.body, "<h3>{}</h3>", escape(title));
    }

    /// A paragraph.
    pub fn text(&mut self, text: &str) {
        let _ = writeln!(self.body, "<p>{}</p>", words(text));
    }

    /// A paragraph that must not be overlooked.
    pub fn note(&mut self, text: &str) {
        let _ = writeln!(self.body, "<p class=\"note\">{}</p>", escape(text));
    }

    /// A command.
    pub fn command(&mut self, what: &str, command: &str) {
        let _ = writeln!(
            self.body,
            "<p>{} <code>{}</code></p>",
            escape(what),
            escape(command)
        );
    }

    /// Links to files beside the page.
    pub fn links(&mut self, links: &[(String, String)]) {
        self.body.push_str("<ul>");
        for (file, name) in links {
            let _ = write!(
                self.body,
                "<li><a href=\"{}\">{}</a></li>",
                escape(file),
                escape(name)
            );
        }
        self.body.push_str("</ul>\n");
    }

    /// Names and what they stand for.
    pub fn facts(&mut self, facts: &[(&str, String)]) {
        self.body.push_str("<dl>");
        for (what, which) in facts {
            let _ = write!(
                self.body,
                "<dt>{}</dt><dd>{}</dd>",
                escape(what),
                escape(which)
            );
        }
        self.body.push_str("</dl>\n");
    }

    /// A chart with the sentence that explains it.
    pub fn figure(&mut self, figure: &Figure, caption: &str) {
        self.figures += 1;
        let _ = writeln!(
            self.body,
            "<figure>{}<figcaption><b>Figure {}.</b> {}</figcaption></figure>",
            svg(figure),
            self.figures,
            words(caption)
        );
    }

    /// A table; columns named in `left` are aligned left.
    pub fn table(&mut self, header: &[&str], records: &[Vec<String>], left: &[usize]) {
        let class = |c: usize| {
            if left.contains(&c) {
                " class=\"l\""
            } else {
                ""
            }
        };
        self.body
            .push_str("<div class=\"scroll\"><table><thead><tr>");
        for (c, name) in header.iter().enumerate() {
            let _ = write!(self.body, "<th{}>{}</th>", class(c), escape(name));
        }
        self.body.push_str("</tr></thead><tbody>\n");
        for record in records {
            self.body.push_str("<tr>");
            for (c, field) in record.iter().enumerate() {
                let _ = write!(self.body, "<td{}>{}</td>", class(c), escape(field));
            }
            self.body.push_str("</tr>\n");
        }
        self.body.push_str("</tbody></table></div>\n");
    }

    /// Pictures side by side.
    pub fn shots(&mut self, shots: &[&Shot]) {
        self.body.push_str("<div class=\"shots\">");
        for shot in shots {
            let _ = write!(
                self.body,
                "<figure><img src=\"data:image/png;base64,{}\" alt=\"{}\" width=\"{}\" height=\"{}\"><figcaption>{}</figcaption></figure>",
                base64(&shot.small),
                escape(&shot.caption),
                shot.size.0,
                shot.size.1,
                escape(&shot.caption)
            );
        }
        self.body.push_str("</div>\n");
    }

    /// The whole file.
    #[must_use]
    pub fn html(&self) -> String {
        let title = escape(&self.title);
        let contents: String = self
            .contents
            .iter()
            .map(|(id, name)| format!("<li><a href=\"#{id}\">{}</a></li>", escape(name)))
            .collect();
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" \
             content=\"width=device-width,initial-scale=1\"><title>{title}</title>\n<style>@font-face{{font-family:'{FAMILY}';\
             src:url(data:font/ttf;base64,{})}}{STYLE}</style></head>\n<body><h1>{title}</h1>\n<nav><ul>{contents}</ul></nav>\n{}</body></html>\n",
            base64(FONT),
            self.body
        )
    }
}

/// Text for a page; what stands between backticks is code.
fn words(text: &str) -> String {
    let mut out = String::new();
    for (i, part) in text.split('`').enumerate() {
        if i > 0 {
            out.push_str(if i % 2 == 1 { "<code>" } else { "</code>" });
        }
        out.push_str(&escape(part));
    }
    if text.matches('`').count() % 2 == 1 {
        out.push_str("</code>");
    }
    out
}

/// Bytes as base64 (RFC 4648, section 4).
#[must_use]
pub fn base64(bytes: &[u8]) -> String {
    const SIGNS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let byte = |i: usize| u32::from(chunk.get(i).copied().unwrap_or(0));
        let word = byte(0) << 16 | byte(1) << 8 | byte(2);
        for k in 0..4 {
            let sign = SIGNS[(word >> (18 - 6 * k)) as usize & 63];
            out.push(if k > chunk.len() {
                '='
            } else {
                char::from(sign)
            });
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_of_the_standards_examples() {
        for (text, wanted) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
            ("foobar", "Zm9vYmFy"),
        ] {
            assert_eq!(base64(text.as_bytes()), wanted);
        }
        assert_eq!(base64(&[0xff, 0xfe, 0xfd]), "//79");
    }

    #[test]
    fn a_page_stands_alone_and_escapes_what_it_is_told() {
        let mut page = Page::new("A <title> & more");
        page.chapter("First");
        page.text("1 < 2");
        page.note("<script>alert(1)</script>");
        page.table(&["a<b", "n"], &[vec!["\"x\"".into(), "1".into()]], &[]);
        let html = page.html();
        for wanted in [
            "A &lt;title&gt; &amp; more",
            "1 &lt; 2",
            "<td>&quot;x&quot;</td>",
            "href=\"#c1\"",
            "&lt;script&gt;",
        ] {
            assert!(html.contains(wanted), "{wanted}");
        }
        for foreign in ["<script", "http://", "https://", "src=\"/", "@import"] {
            assert!(!html.contains(foreign), "{foreign}");
        }
    }
}
