//! A page that needs nothing beside itself, without scripts, for any screen and for print.

use crate::chart::Figure;
use crate::chart::svg::svg;
use crate::files::png;
use crate::table::Table;
use base64::prelude::{BASE64_STANDARD, Engine as _};
use maud::{DOCTYPE, Markup, PreEscaped, html};
use revmap::error::Result;
use revmap_files::Picture;

/// A page in the making.
#[derive(Clone, Debug)]
pub struct Page {
    title: String,
    lead: Vec<String>,
    body: String,
    contents: Vec<(String, String)>,
    figures: usize,
    /// The markup of the first figure.
    first: String,
}

/// Text as wide as it reads well, charts side by side where there is room; tables that scroll by
/// themselves, their first column staying; in print nothing cut apart that fits a page, two charts side by side.
const STYLE: &str = include_str!("page.css");

impl Page {
    /// An empty page.
    pub fn new(title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            lead: Vec::new(),
            body: String::new(),
            contents: Vec::new(),
            figures: 0,
            first: String::new(),
        }
    }

    fn add(&mut self, markup: Markup) {
        self.body += &markup.into_string();
        self.body.push('\n');
    }

    /// A sentence at the top of the page: what was found.
    pub fn lead(&mut self, text: String) {
        self.lead.push(text);
    }

    /// Begins a chapter, listed in the contents.
    pub fn chapter(&mut self, title: &str) {
        let id = format!("c{}", self.contents.len() + 1);
        self.add(html! { h2 id=(id) { (title) } });
        self.contents.push((id, title.to_owned()));
    }

    /// Begins a section of a chapter.
    pub fn heading(&mut self, title: &str) {
        self.add(html! { h3 { (title) } });
    }

    /// A paragraph; what is between backticks is code.
    pub fn text(&mut self, text: &str) {
        self.add(html! { p { (words(text)) } });
    }

    /// A paragraph that must not be overlooked.
    pub fn note(&mut self, text: &str) {
        self.add(html! { p.note { (text) } });
    }

    /// Names and their meanings.
    pub fn facts<T: AsRef<str>>(&mut self, facts: &[(T, String)]) {
        self.add(html! {
            dl { @for (what, which) in facts { dt { (what.as_ref()) } dd { (which) } } }
        });
    }

    /// A chart with the sentence that explains it. The first one is at the top of the page, beside
    /// what was found.
    pub fn figure(&mut self, figure: &Figure, caption: &str) {
        self.figures += 1;
        let id = format!("f{}", self.figures);
        let figure = html! {
            figure id=(id) {
                (PreEscaped(svg(figure)))
                figcaption { b { "Figure " (self.figures) "." } " " (words(caption)) }
            }
        };
        match self.figures {
            1 => {
                self.first = figure.into_string();
                self.add(html! { p { a href="#f1" { "Figure 1" } " is at the top of the page." } });
            }
            _ => self.add(figure),
        }
    }

    /// A table, without the columns that have no value. Words are aligned left, and sentences wrap;
    /// numbers and names stay in one line.
    pub fn table(&mut self, table: &Table) {
        let table = table.filled();
        let any = |c: usize, is: &dyn Fn(&str) -> bool| {
            let mut fields = table.records.iter().filter_map(|r| r.get(c));
            fields.any(|f| is(f))
        };
        let word = |f: &str| f.starts_with(char::is_alphabetic) && f != "inf" && f != "nan";
        let class = |c: usize| match (any(c, &word), any(c, &|f| f.len() > 60)) {
            (true, true) => "l w",
            (true, false) => "l",
            (false, true) => "w",
            (false, false) => "n",
        };
        self.add(html! {
            div.scroll tabindex="0" { table {
                thead { tr {
                    @for (c, name) in table.header.iter().enumerate() { th class=(class(c)) { (name) } }
                } }
                tbody { @for record in &table.records { tr {
                    @for (c, field) in record.iter().enumerate() { td class=(class(c)) { (field) } }
                } } }
            } }
        });
    }

    /// Pictures side by side, each with its caption.
    pub fn shots(&mut self, shots: &[(Picture, String)]) -> Result<()> {
        let mut sources = Vec::new();
        for (picture, _) in shots {
            let bytes = BASE64_STANDARD.encode(png(picture)?);
            sources.push(format!("data:image/png;base64,{bytes}"));
        }
        self.add(html! {
            div.shots { @for ((picture, caption), source) in shots.iter().zip(sources) { figure {
                img src=(source) alt=(caption) width=(picture.width) height=(picture.height);
                figcaption { (caption) }
            } } }
        });
        Ok(())
    }

    /// The whole file.
    pub fn html(&self) -> String {
        let page = html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta name="viewport" content="width=device-width,initial-scale=1";
                    title { (self.title) }
                    style { (PreEscaped(STYLE)) }
                }
                body {
                    h1 { (self.title) }
                    div.top {
                        (PreEscaped(&self.first))
                        div { @for text in &self.lead { p { (words(text)) } } }
                    }
                    nav { details { summary { "Contents" } ul { @for (id, name) in &self.contents {
                        li { a href=(format!("#{id}")) { (name) } }
                    } } } }
                    (PreEscaped(&self.body))
                }
            }
        };
        page.into_string()
    }
}

/// Text for a page; what is between backticks is code.
fn words(text: &str) -> Markup {
    html! { @for (i, part) in text.split('`').enumerate() {
        @if i % 2 == 1 { code { (part) } } @else { (part) }
    } }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_is_whole_and_escapes_its_text() {
        let mut page = Page::new("A <title> & more");
        page.chapter("First");
        page.text("1 < 2, `code`");
        page.note("<script>alert(1)</script>");
        let records = vec![vec!["\"x\"".into(), "–".into(), "1".into()]];
        page.table(&Table::new(["a<b", "empty", "n"], records));
        let html = page.html();
        for wanted in [
            "A &lt;title&gt; &amp; more",
            "1 &lt; 2, <code>code</code>",
            ">&quot;x&quot;</td>",
            "href=\"#c1\"",
            "&lt;script&gt;",
        ] {
            assert!(html.contains(wanted), "{wanted}");
        }
        assert!(!html.contains("empty"), "a column without a value");
        let first = html.find("<div class=\"top\">").zip(html.find("id=\"c1\""));
        assert!(first.is_some_and(|(top, chapter)| top < chapter));
        for foreign in ["<script", "http://", "https://", "src=\"/", "@import"] {
            assert!(!html.contains(foreign), "{foreign}");
        }
    }
}
