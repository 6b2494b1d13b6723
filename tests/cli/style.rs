//! `dosmc fmt` from the command line.

use super::*;

#[test]
fn missions_are_put_into_the_style_where_they_are() {
    let dir = temporary();
    let file = dir.path().join("crooked.dosm");
    let text = fs::read_to_string(root().join(REACH)).expect("a mission").replace(" = ", "  =");
    fs::write(&file, &text).expect("it can be written");
    let (name, crooked) = (path(&file).to_owned(), text.as_bytes());
    let checked = run(&["fmt", "--check", &name]);
    assert_eq!(status(&checked), 1);
    assert!(String::from_utf8_lossy(&checked.stdout).contains("crooked.dosm"));
    assert_eq!(fs::read(&file).expect("it is there"), crooked, "`--check` changes nothing");
    let printed = run_with_input(&["fmt", "-"], crooked);
    assert_eq!(status(&printed), 0);

    let output = run(&["fmt", &name, "--json"]);
    assert_eq!((status(&output), json(&output)["changed"][0].as_str()), (0, Some(name.as_str())));
    assert_eq!(fs::read(&file).expect("it is there"), printed.stdout, "both ways the same");
    assert_ne!(printed.stdout, crooked);
    assert_eq!(status(&run(&["fmt", "--check", &name])), 0);
    assert_eq!(names(dir.path()), ["crooked.dosm"], "no temporary file stays");
}

#[test]
fn what_can_not_be_formatted_is_told_and_left_alone() {
    let dir = temporary();
    let file = dir.path().join("broken.dosm");
    let text = "dosm 1\nregion a=box (0,0)..(1,1)\nregion b=bax (0,0)\n";
    fs::write(&file, text).expect("it can be written");
    let output = run(&["fmt", path(&file)]);
    assert_eq!(status(&output), 0);
    assert!(String::from_utf8_lossy(&output.stderr).contains("1 declaration with errors"), "{output:?}");
    let expected = "dosm 1\nregion a = box (0, 0) .. (1, 1)\nregion b=bax (0,0)\n";
    assert_eq!(fs::read_to_string(&file).expect("it is there"), expected);
    fs::write(&file, b"dosm 1\n\xff").expect("it can be written");
    assert_eq!(status(&run(&["fmt", path(&file)])), 2);
    assert_eq!(fs::read(&file).expect("it is there"), b"dosm 1\n\xff");
    assert_eq!(status(&run(&["fmt", "nowhere.dosm"])), 1);
}
