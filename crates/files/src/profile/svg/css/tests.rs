use super::*;

/// Sheets from line 10 on, `/n` for the ends of lines. Their rules: number of selectors,
/// declarations, what is not read, line.
const SHEETS: &str = "
@charset 'a';<!-- .a, .b { Fill: url(a;b) !important; --X:1 } --> => 2 fill=url(a;b)!;--X=1 - 10
/* {/n */@font-face { font-family: 'a}' } @media print { a { fill: red } } a{} => 1  - 11
@media screen { c { d: 'x;y' } } e{f:g => 1 d='x;y' - 10|1 f=g - 10
a:has(b) {c:d} => 0 c=d a:has(b) 10
@supports (x: y) { a {c:d} } => 1 c=d @supports (x: y) 10
@media (min-width: 9px) { a {c:d} } => 1 c=d @media (min-width: 9px) 10
@import 'a.css'; a{b:c} => 1 b=c - 10
a, .b {c:1; &:hover, d {e:2} > f {g:3} --h:{i:4}} => 2 c=1 - 10|2 e=2 - 10|1 g=3 - 10|2 --h={i:4} - 10
a, .b {@media screen {j:5} k:6} => 2 j=5 - 10|2 k=6 - 10";
/// Conditions of media that hold (+), do not (-), or are not read (?).
const MEDIA: &str = "+|+screen|+print, screen|+not print|-only screen and (prefers-color-scheme: dark)|\
    ?screen and (min-width: 100px)|-print and (min-width: 100px)";

fn rules(text: &str) -> Vec<String> {
    let all = sheet(text, 10, &mut Notes::default());
    let declared = |d: &Declaration| {
        let important = if d.important { "!" } else { "" };
        format!("{}={}{important}", d.name, d.value)
    };
    let told = |r: &Rule| {
        let declared: Vec<String> = r.declarations.iter().map(declared).collect();
        let unread = r.unread.as_deref().unwrap_or("-");
        let (count, declared) = (r.selectors.len(), declared.join(";"));
        format!("{count} {declared} {unread} {}", r.line)
    };
    all.iter().map(told).collect()
}

#[test]
fn sheets_are_read_in_order() {
    for (text, wanted) in SHEETS.lines().filter_map(|line| line.split_once(" => ")) {
        assert_eq!(rules(&text.replace("/n", "\n")).join("|"), wanted);
    }
    let deep = rules(&("a {".repeat(40) + "b:c" + &"}".repeat(40)));
    assert!(deep[0].starts_with("0 --any=0 "), "{deep:?}");
    assert_eq!(nested("d, e", "a"), ":is(a) d,:is(a) e");
    for case in MEDIA.split('|') {
        let wanted = (!case.starts_with('?')).then(|| case.starts_with('+'));
        assert_eq!(media(&case[1..]), wanted, "{case}");
    }
}
