//! Figures as PDF, for papers: as wide as a column, without the title, words as text of the charts'
//! own font, so that a reader can search and copy them.

use super::letters::{FONT, face, width};
use super::style::Dash;
use super::{Figure, Mark};
use pdf_writer::types::{CidFontType, FontFlags, LineJoinStyle, SystemInfo, UnicodeCmap};
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, Str, TextStr};

/// Width of a page: a column of a paper of two columns, points.
const COLUMN: f64 = 241.0;

/// The font's name in the file.
const FONT_NAME: Name = Name(b"DejaVuSans");
/// The font's name on the page.
const FONT_KEY: Name = Name(b"F");
/// Codes of the text are the font's own glyphs.
const GLYPHS: SystemInfo = SystemInfo {
    registry: Str(b"Adobe"),
    ordering: Str(b"Identity"),
    supplement: 0,
};

/// A figure as a PDF of one page.
pub(crate) fn pdf(figure: &Figure) -> Vec<u8> {
    let points = COLUMN / figure.width.max(1.0);
    let height = figure.height - figure.top;
    let mut content = Content::new();
    // Pixels count downwards from the upper left corner, points upwards from the lower left one.
    let scale = points as f32;
    let lowest = (figure.height * points) as f32;
    content.transform([scale, 0.0, 0.0, -scale, 0.0, lowest]);
    content.set_line_join(LineJoinStyle::RoundJoin);
    for mark in &figure.marks {
        if mark.bounds()[3] > figure.top {
            draw(&mut content, mark);
        }
    }
    let [catalog, pages, page, stream, info, font] = [1, 2, 3, 4, 5, 6].map(Ref::new);
    let mut file = Pdf::new();
    file.catalog(catalog).pages(pages);
    file.document_info(info)
        .title(TextStr(&figure.title))
        .creator(TextStr("revmap"));
    file.pages(pages).kids([page]).count(1);
    let mut sheet = file.page(page);
    sheet.media_box(Rect::new(0.0, 0.0, COLUMN as f32, (height * points) as f32));
    sheet.parent(pages).contents(stream);
    sheet.resources().fonts().pair(FONT_KEY, font);
    sheet.finish();
    file.stream(stream, &content.finish());
    embed(&mut file, [6, 7, 8, 9, 10].map(Ref::new));
    file.finish()
}

/// Embeds the font: its glyphs, their widths, and the letters that they stand for.
fn embed(file: &mut Pdf, [font, glyphs, descriptor, data, letters]: [Ref; 5]) {
    let Some(face) = face() else { return };
    file.type0_font(font)
        .base_font(FONT_NAME)
        .encoding_predefined(Name(b"Identity-H"))
        .descendant_font(glyphs)
        .to_unicode(letters);
    let unit = 1000.0 / f32::from(face.units_per_em());
    let advance = |glyph| {
        let advance = face.glyph_hor_advance(ttf_parser::GlyphId(glyph));
        advance.map_or(0.0, |a| unit * f32::from(a))
    };
    let mut own = file.cid_font(glyphs);
    own.subtype(CidFontType::Type2).base_font(FONT_NAME);
    own.system_info(GLYPHS).font_descriptor(descriptor);
    own.cid_to_gid_map_predefined(Name(b"Identity"));
    let all = (0..face.number_of_glyphs()).map(advance);
    own.widths().consecutive(0, all);
    own.finish();
    let [left, low, right, high] = {
        let b = face.global_bounding_box();
        [b.x_min, b.y_min, b.x_max, b.y_max].map(|v| unit * f32::from(v))
    };
    file.font_descriptor(descriptor)
        .name(FONT_NAME)
        .flags(FontFlags::SYMBOLIC)
        .bbox(Rect::new(left, low, right, high))
        .italic_angle(0.0)
        .ascent(unit * f32::from(face.ascender()))
        .descent(unit * f32::from(face.descender()))
        .cap_height(unit * f32::from(face.capital_height().unwrap_or(face.ascender())))
        .stem_v(80.0)
        .font_file2(data);
    let packed = miniz_oxide::deflate::compress_to_vec_zlib(FONT, 6);
    file.stream(data, &packed).filter(Filter::FlateDecode);
    let mut map = UnicodeCmap::<u16>::new(Name(b"Letters"), GLYPHS);
    // The charts' signs: Latin, punctuation, sub- and superscripts, arrows, mathematics.
    for letter in (0x20..0x2300).filter_map(char::from_u32) {
        if let Some(glyph) = face.glyph_index(letter) {
            map.pair(glyph.0, letter);
        }
    }
    file.cmap(letters, &map.finish());
}

fn draw(content: &mut Content, mark: &Mark) {
    match mark {
        Mark::Shape(points, fill, stroke) => {
            let [r, g, b] = rgb(fill);
            content.set_fill_rgb(r, g, b);
            pen(content, stroke.0, stroke.1, Dash::SOLID);
            path(content, points);
            content.close_path().fill_nonzero_and_stroke();
        }
        Mark::Line(points, color, width, dash) => {
            pen(content, color, *width, *dash);
            path(content, points);
            content.stroke();
        }
        Mark::Word(word) => {
            let back = word.anchor.back(width(&word.text, word.size)) as f32;
            let (x, y) = (word.at.0 as f32, word.at.1 as f32);
            let matrix = match word.upwards {
                true => [0.0, -1.0, -1.0, 0.0, x, y + back],
                false => [1.0, 0.0, 0.0, -1.0, x - back, y],
            };
            let [r, g, b] = rgb(word.color);
            content.set_fill_rgb(r, g, b).begin_text();
            content.set_font(FONT_KEY, word.size as f32);
            content.set_text_matrix(matrix);
            content.show(Str(&codes(&word.text))).end_text();
        }
    }
}

/// The glyphs of a word, two bytes each.
fn codes(text: &str) -> Vec<u8> {
    let glyph = |c| face()?.glyph_index(c);
    let all = text.chars().map(|c| glyph(c).map_or(0, |g| g.0));
    all.flat_map(u16::to_be_bytes).collect()
}

fn path(content: &mut Content, points: &[(f64, f64)]) {
    for (i, (x, y)) in points.iter().enumerate() {
        let (x, y) = (*x as f32, *y as f32);
        match i {
            0 => content.move_to(x, y),
            _ => content.line_to(x, y),
        };
    }
}

fn pen(content: &mut Content, color: &str, width: f64, dash: Dash) {
    let [r, g, b] = rgb(color);
    content.set_stroke_rgb(r, g, b);
    content.set_line_width(width as f32);
    content.set_dash_pattern(dash.0.iter().copied(), 0.0);
}

/// `#rrggbb` as parts of 1.
fn rgb(color: &str) -> [f32; 3] {
    [1, 3, 5].map(|at| {
        let byte = color.get(at..at + 2).map(|h| u8::from_str_radix(h, 16));
        byte.map_or(0.0, |b| f32::from(b.unwrap_or(0)) / 255.0)
    })
}

#[cfg(test)]
mod tests {
    use super::super::Anchor;
    use super::super::style::INK;
    use super::*;

    #[test]
    fn what_lies_below_the_title_is_on_the_page_as_text() {
        let word = |y, text| Mark::word((10.0, y), text, 10.0, Anchor::Start, INK);
        let points = vec![(10.0, 50.0), (90.0, 70.0)];
        let line = Mark::Line(points, "#ff0000", 2.0, Dash::GUIDE);
        let figure = Figure {
            width: 482.0,
            height: 80.0,
            top: 20.0,
            title: "A title".into(),
            marks: vec![word(12.0, "title"), word(40.0, "I"), line],
        };
        let bytes = pdf(&figure);
        let file = String::from_utf8_lossy(&bytes).into_owned();
        assert!(file.starts_with("%PDF-1.") && file.ends_with("%%EOF"));
        let line = "10 50 m\n90 70 l\nS";
        for part in ["/MediaBox [0 0 241 30]", "1 0 0 RG", "[5 4] 0 d", line] {
            assert!(file.contains(part), "{part}: {file}");
        }
        // One word is shown, as text; the title is not.
        assert_eq!(file.matches("Tj").count(), 1);
        assert!(file.contains("/FontFile2") && file.contains("/ToUnicode"));
        assert!(bytes.len() < 60_000, "{}", bytes.len());
    }
}
