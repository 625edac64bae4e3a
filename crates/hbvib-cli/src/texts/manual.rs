//! Completions of shells and the manual page, from the description of the arguments.

use crate::texts::arguments::{Arguments, ShellName};
use crate::texts::outcome::Outcome;
use clap::CommandFactory;
use clap_complete::Shell;
use clap_complete::generate as completions_of;
use clap_mangen::Man;

/// Completions of a shell.
pub fn completions(shell: ShellName) -> String {
    let shell = match shell {
        ShellName::Bash => Shell::Bash,
        ShellName::Zsh => Shell::Zsh,
        ShellName::Fish => Shell::Fish,
    };
    let mut text = Vec::new();
    completions_of(shell, &mut Arguments::command(), "hbvib", &mut text);
    String::from_utf8_lossy(&text).into_owned()
}

/// The manual page: the command, and a section for each verb.
///
/// # Errors
/// A sentence.
pub fn page() -> Outcome<String> {
    let said = |e: std::io::Error| e.to_string();
    let mut command = Arguments::command();
    command.build();
    let mut text = Vec::new();
    let page = Man::new(command.clone()).section("1");
    page.render_title(&mut text).map_err(said)?;
    page.render_name_section(&mut text).map_err(said)?;
    page.render_synopsis_section(&mut text).map_err(said)?;
    page.render_description_section(&mut text).map_err(said)?;
    page.render_options_section(&mut text).map_err(said)?;
    for verb in command.get_subcommands().filter(|verb| verb.get_name() != "help") {
        text.extend(format!(".SH \"HBVIB {}\"\n", verb.get_name().to_uppercase()).bytes());
        let part = Man::new(verb.clone());
        let mut body = Vec::new();
        part.render_synopsis_section(&mut body).map_err(said)?;
        part.render_description_section(&mut body).map_err(said)?;
        part.render_options_section(&mut body).map_err(said)?;
        part.render_extra_section(&mut body).map_err(said)?;
        // Sections of a verb are parts of its section.
        text.extend(String::from_utf8_lossy(&body).replace(".SH ", ".SS ").bytes());
    }
    page.render_extra_section(&mut text).map_err(said)?;
    Ok(String::from_utf8_lossy(&text).into_owned())
}
