use super::*;

/// The rules of a sheet from line 10 on: number of selectors, declarations, what is not read, line.
fn rules(text: &str) -> Vec<String> {
    let all = sheet(text, 10, &mut Notes::default());
    let declared = |d: &Declaration| {
        format!(
            "{}={}{}",
            d.name,
            d.value,
            if d.important { "!" } else { "" }
        )
    };
    let told = |r: &Rule| {
        let declared: Vec<String> = r.declarations.iter().map(declared).collect();
        let unread = r.unread.as_deref().unwrap_or("-");
        format!(
            "{} {} {unread} {}",
            r.selectors.len(),
            declared.join(";"),
            r.line
        )
    };
    all.iter().map(told).collect()
}

#[test]
fn sheets_are_read_in_order() {
    for (text, wanted) in [
        (
            "@charset 'a';<!-- .a, .b { Fill: url(a;b) !important; --X:1 } -->/* {\n */\n\
             @font-face { font-family: 'a}' } @media print { a { fill: red } }\n\
             @media screen { c { d: 'x;y' } } e{f:g",
            &[
                "2 fill=url(a;b)!;--X=1 - 10",
                "1 d='x;y' - 13",
                "1 f=g - 13",
            ][..],
        ),
        ("a:has(b) {c:d}", &["0 c=d a:has(b) 10"]),
        (
            "@supports (x: y) { a {c:d} }",
            &["1 c=d @supports (x: y) 10"],
        ),
        (
            "@media (min-width: 9px) { a {c:d} }",
            &["1 c=d @media (min-width: 9px) 10"],
        ),
        ("@import 'a.css'; a{b:c}", &["1 b=c - 10"]),
        (
            "a, .b {c:1; &:hover, d {e:2} > f {g:3} --h:{i:4}; @media screen {j:5} k:6}",
            &[
                "2 c=1 - 10",
                "2 e=2 - 10",
                "1 g=3 - 10",
                "2 --h={i:4} - 10",
                "2 j=5 - 10",
                "2 k=6 - 10",
            ],
        ),
    ] {
        assert_eq!(rules(text), wanted, "{text}");
    }
    let deep = rules(&("a {".repeat(40) + "b:c" + &"}".repeat(40)));
    assert!(deep[0].starts_with("0 --any=0 a"), "{deep:?}");
    assert_eq!(nested("d, e", "a"), ":is(a) d,:is(a) e");
}

#[test]
fn conditions_of_media() {
    for (text, wanted) in [
        ("", Some(true)),
        ("screen", Some(true)),
        ("print, screen", Some(true)),
        ("not print", Some(true)),
        ("only screen and (prefers-color-scheme: dark)", Some(false)),
        ("screen and (min-width: 100px)", None),
        ("print and (min-width: 100px)", Some(false)),
    ] {
        assert_eq!(media(text), wanted, "{text}");
    }
}
