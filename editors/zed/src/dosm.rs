//! Tells Zed how the language server of missions is started: `dosmc lsp`, from the path or from the settings.

use zed_extension_api::settings::LspSettings;
use zed_extension_api::{self as zed, Command, LanguageServerId, Result, Worktree};

/// The server's name in `extension.toml` and in the settings.
const SERVER: &str = "dosmc";

struct Dosm;

impl zed::Extension for Dosm {
    fn new() -> Dosm {
        Dosm
    }

    fn language_server_command(&mut self, _: &LanguageServerId, worktree: &Worktree) -> Result<Command> {
        let settings = LspSettings::for_worktree(SERVER, worktree).ok();
        let binary = settings.and_then(|settings| settings.binary);
        let (path, arguments) = binary.map_or((None, None), |binary| (binary.path, binary.arguments));
        let command = path
            .or_else(|| worktree.which(SERVER))
            .ok_or("dosmc is not on the path: install it, or set lsp.dosmc.binary.path in the settings")?;
        Ok(Command {
            command,
            args: arguments.unwrap_or_else(|| vec!["lsp".to_owned()]),
            env: worktree.shell_env(),
        })
    }

    fn language_server_initialization_options(
        &mut self,
        _: &LanguageServerId,
        worktree: &Worktree,
    ) -> Result<Option<zed::serde_json::Value>> {
        let settings = LspSettings::for_worktree(SERVER, worktree)?;
        Ok(settings.initialization_options)
    }
}

zed::register_extension!(Dosm);
