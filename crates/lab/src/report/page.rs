//! A page that needs nothing beside itself: text, tables, charts and pictures in one HTML file,
//! without scripts, for screens of any width and for print.

use super::chart::Figure;
use super::chart::letters::{FAMILY, FONT};
use super::chart::svg::{escape, svg};
use super::pictures::Shot;
use super::table::Table;
use base64::prelude::{BASE64_STANDARD, Engine as _};
use std::fmt::Write;

/// A page in the making.
#[derive(Clone, Debug)]
pub struct Page {
    title: String,
    body: String,
    contents: Vec<(String, String)>,
    figures: usize,
}

/// Style: one column as wide as a chart reads well; tables that scroll on their own, their first
/// column staying, shadows telling that there is more; in print nothing cut apart that fits a page,
/// headings with what follows them, two charts side by side.
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
nav li{padding:.15rem 0}
a{color:#0072b2}
figure{margin:1rem 0}
figure svg{display:block;width:100%;height:auto;max-width:36rem}
figcaption{font-size:.92rem;color:#444;max-width:46rem;margin-top:.4rem}
.scroll{overflow-x:auto;max-width:100%;margin:.6rem 0;background:linear-gradient(270deg,#fff 30%,#fff0) 100% 0/3rem 100% no-repeat local,\
linear-gradient(270deg,#0003,#0000) 100% 0/.9rem 100% no-repeat scroll,#fff}
table{border-collapse:separate;border-spacing:0;font-size:.88rem;font-variant-numeric:tabular-nums}
th,td{padding:.25rem .6rem;text-align:right;white-space:nowrap;border-top:1px solid #e5e5e5}
th{border-top:0;border-bottom:2px solid #888;text-align:right;vertical-align:bottom;white-space:normal;min-width:4.5em}
th:first-child,td:first-child,th.l,td.l{text-align:left}
th:first-child,td:first-child{position:sticky;left:0;background:#fff}
td.w{white-space:normal;min-width:16em;max-width:34em;overflow-wrap:break-word}
dl{display:grid;grid-template-columns:max-content 1fr;gap:.15rem 1rem;margin:.5rem 0;max-width:46rem}
dt{color:#555}
dd{margin:0;overflow-wrap:anywhere}
.shots{display:grid;grid-template-columns:repeat(4,1fr);gap:.8rem;margin:.8rem 0}
.shots:has(:only-child){grid-template-columns:minmax(0,26rem)}
.shots figure{margin:0}
.shots img{display:block;width:100%;height:auto;border:1px solid #ccc}
.shots figcaption{font-size:.85rem}
.note{border-left:4px solid #d55e00;padding:.3rem .8rem;background:#fdf4ee}
@media(max-width:44rem){.shots{grid-template-columns:repeat(2,1fr)}th,td{padding:.25rem .35rem}table{font-size:.82rem}th{min-width:3.6em}}
@media(max-width:34rem){dl{grid-template-columns:1fr}dt{margin-top:.4rem}body{padding:.8rem}}
@media print{@page{size:A4;margin:14mm}body{max-width:none;padding:0;font-size:10pt;line-height:1.35}h1{font-size:16pt}h2{font-size:13pt}h3{font-size:11pt}h2,h3{break-after:avoid}\
p{orphans:3;widows:3}figure,.shots figure{break-inside:avoid}figure{display:inline-block;width:48.5%;margin:.3rem .5%;vertical-align:top}.shots figure{display:block;width:auto}figure svg{width:auto;max-width:100%;max-height:20cm}figcaption{max-width:none;font-size:8pt}.scroll{overflow:visible;background:none}\
thead{display:table-header-group}tr{break-inside:avoid}th,td{padding:.06rem .22rem;white-space:normal}td.n,td:first-child{white-space:nowrap}th{min-width:0}td.w{min-width:0}table{font-size:7.5pt;line-height:1.25}\
th:first-child,td:first-child{position:static}.shots{gap:.4rem}.shots:has(:only-child){grid-template-columns:minmax(0,8cm)}nav{display:none}a{color:inherit;text-decoration:none}code{background:none;padding:0}}
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
    pub fn table(&mut self, table: &Table, left: &[usize]) {
        // Sentences wrap; numbers and names stay in one line.
        let wide = |c: usize| {
            let mut records = table.records.iter();
            records.any(|r| r.get(c).is_some_and(|f| f.len() > 60))
        };
        let class = |c: usize| match (left.contains(&c), wide(c)) {
            (true, true) => " class=\"l w\"",
            (true, false) => " class=\"l\"",
            (false, true) => " class=\"w\"",
            (false, false) => " class=\"n\"",
        };
        self.body
            .push_str("<div class=\"scroll\" tabindex=\"0\"><table><thead><tr>");
        for (c, name) in table.header.iter().enumerate() {
            let _ = write!(self.body, "<th{}>{}</th>", class(c), escape(name));
        }
        self.body.push_str("</tr></thead><tbody>\n");
        for record in &table.records {
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
                BASE64_STANDARD.encode(&shot.small),
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
            BASE64_STANDARD.encode(FONT),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_stands_alone_and_escapes_what_it_is_told() {
        let mut page = Page::new("A <title> & more");
        page.chapter("First");
        page.text("1 < 2");
        page.note("<script>alert(1)</script>");
        let records = vec![vec!["\"x\"".into(), "1".into()]];
        page.table(&Table::new(["a<b", "n"], records), &[]);
        let html = page.html();
        for wanted in [
            "A &lt;title&gt; &amp; more",
            "1 &lt; 2",
            ">&quot;x&quot;</td>",
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
