//! Bad searches: each is named with what is wrong in it, and costs a run nothing but its own rows.

use super::*;
use crate::run::table;

/// Faults of `search.toml`, of names, and of values of parameters: nothing is drawn.
#[test]
fn faults_of_descriptions_name_the_file_and_the_remedy() {
    let parameters = "[parameters.omega]\nabout = 'x'\ndefault = 1.5\nrange = [1.0, 2.0]\n";
    let whole = format!("{TOML}{parameters}");
    for row in table(
        "'map' => 'mapp'                       | line 5 | mapp | binary map
         'map' => 'map                         | line 5
         bevels = true => bevels = 1; bevel = 2 | line 7 | bevel
         inside => insight                     | line 7 | insight
         name = 'mine' =>                      | name
         'mine' => 'My search'                 | name | small letters
         'a test' => ' '                       | about | empty
         [steps]; default = 64 =>              | steps | missing
         default = 64 => default = 0           | steps | 1 or more
         'map' => 'table'                      | table | missing | program
         64 => 64; [table]; program = ['a']    | table | reads =
         [steps] => glsl = 'other.glsl'; [steps] | glsl | other.glsl
         1.5 => 3.5                            | parameters.omega | outside
         1.5 => 1                              | parameters.omega | two kinds",
    ) {
        let own = own_search(&changed(&whole, row[0]), &format!("{HEAD}{BODY}"));
        let words = [&["mine/search.toml"], &row[1..]].concat();
        own.refused(&format!("{RENDER} mine"), 2, &words);
    }
    let own = own_search(&format!("{TOML}{parameters}"), &format!("{HEAD}{BODY}"));
    renders(&own, "mine:omega=1.9");
    let tries = "mine:omga=1.2  | omga   | give one of omega
                 mine:omega=2.5 | 1.0 to 2.0
                 mine:omega=x   | a number
                 ./none         | none/search.toml | searches new
                 none           | possible values";
    for row in table(tries) {
        own.refused(&format!("{RENDER} {}", row[0]), 2, &row[1..]);
    }
    std::fs::remove_file(own.path("mine/search.glsl")).unwrap();
    let words = ["glsl", "search.glsl", "not in the folder"];
    own.refused(&format!("{RENDER} mine"), 2, &words);
}

/// Errors of GLSL name the line of the person's own file.
#[test]
fn errors_of_glsl_name_file_and_line() {
    for (n, row) in table(
        "++steps; => s += omega;      | mine/search.glsl:6: | omega | undeclared
         ++steps; => ++steps          | mine/search.glsl:7: | syntax
         uint search => #include \"none.glsl\"; uint search | mine/search.glsl:1: | none.glsl
         uint search => #include \"own.glsl\"; uint search  | mine/own.glsl:2: | syntax
         uint search => uint find     | mine/search.glsl | does not define | uint search(Meridian m
         float pixel, =>              | mine/search.glsl | does not define
         uint search => ; float search | mine/search.glsl:2: search returns float | uint search(Meridian m
         END =>                       | mine/search.glsl:1: | does not return a value
         END => if (s > m.s_end) { return LEFT;} | mine/search.glsl | `search` can end without a return",
    )
    .enumerate()
    {
        let glsl = changed(&format!("{HEAD}{BODY}"), row[0]);
        // The text that is compiled differs.
        let inside = ["inside = true", "inside = false"][n % 2];
        let own = own_search(&TOML.replace("inside = true", inside), &glsl);
        own.file("mine/own.glsl", "\nvec5 x;\n");
        own.refused(&format!("{RENDER} mine"), 1, &row[1..]);
    }
    // Every way through these functions returns.
    let near = "return f < 1e-3 ? FOUND : EXHAUSTED;";
    for end in [
        format!("if (s > m.s_end) {{ return LEFT; }} else {{ {near} }}"),
        format!("for (;;) {{ if (s > m.s_end) {{ return LEFT; }} {near} }}"),
        format!("switch (int(s > m.s_end)) {{ case 1: return LEFT; default: {near} }}"),
    ] {
        renders(&ending(&end), "mine");
    }
    // A table of which the eye may be inside.
    let toml = reading("'table'") + "[table]\nprogram = ['true']\n";
    let own = own_search(&toml, &quadric_search("quadric = vec4(1.0); return LEFT;"));
    let words = [
        "mine/search.glsl: search.toml says inside = true",
        "`bool starts_in_table(Meridian m)`",
        "inside = false",
    ];
    own.refused("searches ./mine", 1, &words);
}

/// What the picture of `searches` shows is a warning there, and in a run that tries the folder.
#[test]
fn a_search_that_hits_nothing_or_passes_its_limit_is_named() {
    let none = ending("return LEFT;");
    let said = lines(&none.run("searches ./mine"));
    let warned = "warning: mine hits nothing in the test picture of the fragment stage";
    assert!(said.iter().any(|l| l.starts_with(warned)), "{said:?}");
    let all = none.run("searches ./mine ./mine");
    let text = String::from_utf8(all.stdout).unwrap();
    assert!(!text.contains("NaN") && !text.contains("-0"), "{text}");
    assert!(text.contains("hits nothing"), "{text}");
    // A folder is described once.
    assert_eq!(text.matches("  licence ").count(), 1, "{text}");
    let bench =
        "bench scene.toml --size 64x48 --quick --passes 2 --rounds 1 --solver mine,circle -o out";
    let said = lines(&none.run(bench));
    assert!(said.iter().any(|l| l.starts_with(warned)), "{said:?}");

    let body = BODY.replace("i < most_steps() && f > 1e-4", "i < 400");
    let long = own_search(TOML, &format!("{HEAD}{body}"));
    let said = lines(&long.run("searches ./mine"));
    let warned =
        "look-ups for a pixel in the compute stage, but most_steps() is 64: bound the loop";
    assert!(said.iter().any(|l| l.contains(warned)), "{said:?}");
    assert!(lines(&good().run("searches ./mine")).is_empty());
}

#[test]
fn the_limit_of_a_frame_is_a_number_of_seconds() {
    let mut own = good();
    limit(&mut own, "7.5");
    renders(&own, "mine");
    limit(&mut own, "abc");
    let words = ["REVMAP_TIME_LIMIT is \"abc\"", "seconds"];
    own.refused(&format!("{RENDER} mine"), 2, &words);
}

/// What only a picture shows: `render` warns, a bench leaves the search out.
#[test]
fn wrong_values_are_counted() {
    let no_number = "no number (NaN or infinite) in";
    for (line, word) in [
        ("s = sqrt(-1.0 - s * s); return FOUND;", no_number),
        ("s = 1.0 / (s - s); return FOUND;", no_number),
        ("return s > m.s_end ? LEFT : 7u;", "wrong value in"),
    ] {
        let said = renders(&ending(line), "mine");
        let is = |l: &String| l.contains("warning: mine/search.glsl") && l.contains(word);
        assert!(said.iter().any(is), "{said:?}");
    }
    // A solid that the search does not draw.
    let toml = TOML.replace("bevels = true", "bevels = false");
    let own = own_search(&toml, &format!("{HEAD}{BODY}"));
    renders(&own, "mine");
    let beveled = format!("{RENDER} mine --set object.0.bevel=0.2");
    own.refused(&beveled, 1, &["bevel", "mine", "bevels = false"]);
}

/// A search that does not end is ended, and the others of its run are measured.
#[test]
fn an_endless_search_ends_no_run() {
    // Lavapipe ends all loops of a shader after 65536 turns, which take seconds if they are long.
    let endless = |when: &str| {
        let turn = (0..8).fold("f".to_owned(), |s, _| format!("field(point_rz(m, {s}))"));
        let turns = format!("while ({when}) {{ f = min(f, {turn}); }}");
        HEAD.to_owned() + &BODY.replacen('{', &format!("{{\n    {turns}"), 1)
    };
    let mut own = own_search(TOML, &endless("f > -9.0"));
    limit(&mut own, "2");
    let words = ["a frame by mine took more than 2 seconds", "most_steps()"];
    own.refused(
        "render scene.toml --size 640x480 -o b.png --solver mine",
        1,
        &words,
    );
    let scene = "scene.toml --size 640x480 --quick";
    left_out(&own, scene, "took more than 2 seconds");
    // Endless for one scene of the run alone: the test picture does not show it.
    // The limit leaves room for the test picture's compilation on a busy machine.
    let mut own = own_search(TOML, &endless("f > -9.0 && shape.extend > 0.0"));
    limit(&mut own, "10");
    own.object("polygon = [[0, 0.1], [0.3, 0.1], [0, 0.9]]\nextend = 0.01");
    left_out(&own, scene, "begins again without mine");
}

/// A run by `mine` and `circle` has the rows of `circle`, and says why those of `mine` are missing.
#[track_caller]
fn left_out(own: &Bench, what: &str, why: &str) {
    let bench = format!("bench {what} --solver mine,circle --passes 2 --rounds 1 -o out");
    let said = lines(&own.done(&bench)).join("\n");
    println!("{said}");
    holds(&said, &[why, "warning: mine was left out"]);
    let results = own.text("out/results.csv");
    assert!(results.contains(",circle,") && !results.contains(",mine,"));
    holds(&own.text("out/excluded.csv"), &["mine"]);
}

#[test]
fn a_run_measures_the_others_and_names_the_origin() {
    let own = own_search(
        TOML,
        &format!("{HEAD}{}", BODY.replace("f > 1e-4", "nothing")),
    );
    left_out(
        &own,
        "scene.toml --size 64x48 --quick",
        "mine/search.glsl:3:",
    );
    let table = own.run("stability cone-tip --quick --solver mine,circle,exact -o s");
    holds(
        &lines(&table).join("\n"),
        &["mine failed: ", "mine/search.glsl:3:"],
    );
    // One that works stands in both reports with its origin.
    let own = good();
    let two = "--passes 2 --rounds 1 -o";
    let scene = "scene.toml --size 64x48 --quick --solver ./mine,circle";
    own.done(&format!("bench {scene} {two} out"));
    own.run("stability cone-tip --quick --solver ./mine,exact -o s");
    holds(&own.text("out/results.csv"), &[",mine,"]);
    for file in ["out/report.html", "out/machine.txt", "s/report.html"] {
        let origin = "not revmap's own: folder ./mine, files ";
        holds(&own.text(file), &[origin]);
    }
    // As a plan names it.
    let plan = "about = 'x'\ntitle = 'x'\nviews = [{ name = 'one', solids = ['vase'] }]\n\
        measure = [{ methods = ['./mine', 'circle'], sizes = ['64x48'] }]\nshow = []\n";
    own.file("plan.toml", plan);
    own.done(&format!("bench --plan plan.toml {two} p"));
    holds(&own.text("p/results.csv"), &[",mine,"]);
}

/// Tables of a program, good and bad.
#[cfg(unix)]
#[test]
fn programs_make_tables_within_limits() {
    use std::os::unix::fs::PermissionsExt;
    let toml = reading("'table'").replace("inside = true\n", "");
    let toml = format!("{toml}[table]\nprogram = ['table.sh', 'word']\n");
    // A cylinder whose radius the table holds.
    let glsl = quadric_search(
        "float r = table_vector(table_length() - 1u).w;
    ++steps;
    quadric = vec4(1.0, 0.0, 0.0, 0.0);
    float root = m.b * m.b - m.a * (m.c - r * r);
    s = (-m.b - sqrt(max(root, 0.0))) / m.a;
    return root > 0.0 && s > 0.0 && s < m.s_end ? FOUND : LEFT;",
    );
    let mut own = own_search(&toml, &glsl);
    let file: PathBuf = own.path("mine/table.sh");
    let program = |text: &str| {
        std::fs::write(&file, format!("#!/bin/sh\n{text}\n")).unwrap();
        std::fs::set_permissions(&file, PermissionsExt::from_mode(0o755)).unwrap();
    };
    program("cat > input.json; test $1 = word && echo '0 0 0 0, 1e-1 2 3 0.2'");
    renders(&own, "./mine");
    limit(&mut own, "2");
    let input = own.text("mine/input.json");
    assert!(input.starts_with("{\"rows\": 512"), "{input}");
    holds(&input, &["\"chains\": [[["]);
    for (text, words) in [
        (
            "echo 'no outline' >&2; exit 3",
            "`table.sh word` failed, exit status: 3, no outline",
        ),
        ("sleep 60", "took more than 2 seconds"),
        ("echo 1 2 three 4", "\"three\", number 3"),
        ("echo 1 2 nan 4", "\"nan\", finite"),
        ("echo 1 2 3", "wrote 3 numbers, four"),
        ("true", "wrote 0 numbers"),
        ("yes 1 2 3 4", "took more than 2 seconds|wrote more than"),
    ] {
        program(text);
        let output = own.run(&format!("{RENDER} mine"));
        let said = lines(&output);
        assert_eq!((output.status.code(), said.len()), (Some(1), 1), "{said:?}");
        println!("{}", said[0]);
        for word in words.split(", ") {
            let is_said = word.split('|').any(|word| said[0].contains(word));
            assert!(is_said, "no {word:?} in {said:?}");
        }
    }
    std::fs::remove_file(own.path("mine/table.sh")).unwrap();
    let words = ["`table.sh word` cannot be started"];
    own.refused(&format!("{RENDER} mine"), 1, &words);
}
