// Starts `dosmc lsp` for missions, and has the commands of the palette.

import * as os from "node:os";
import * as vscode from "vscode";
import {
  Executable,
  LanguageClient,
  LanguageClientOptions,
  RevealOutputChannelOn,
  State,
} from "vscode-languageclient/node";

import { showPicture } from "./picture";
import { findProgram, notFound, Surroundings } from "./program";

/** Where the guide says how to install the compiler. */
const HOW_TO_INSTALL = "`cargo install --path .` in a clone of dosmc installs it.";

/** The settings that the server is started with. */
const SETTINGS = ["dosmc.path", "dosmc.arguments", "dosmc.environment"];

let client: LanguageClient | undefined;
let log: vscode.LogOutputChannel;
let item: vscode.LanguageStatusItem;
/** Starts and stops come one after the other. */
let queue: Promise<void> = Promise.resolve();

export async function activate(context: vscode.ExtensionContext): Promise<void> {
  log = vscode.window.createOutputChannel("dosm", { log: true });
  item = vscode.languages.createLanguageStatusItem("dosmc", { language: "dosm" });
  item.name = "dosmc";
  item.command = { command: "dosmc.showLog", title: "Show log" };
  const command = (name: string, run: () => unknown) => vscode.commands.registerCommand(name, run);
  context.subscriptions.push(
    log,
    item,
    command("dosmc.planMission", () => ask("dosmc.solve")),
    command("dosmc.showPicture", () => ask("dosmc.openPicture")),
    command("dosmc.showPage", () => ask("dosmc.openPage")),
    command("dosmc.restartServer", restart),
    command("dosmc.showLog", () => log.show()),
    vscode.workspace.onDidChangeConfiguration((change) => {
      const ours = SETTINGS.some((key) => change.affectsConfiguration(key));
      if (ours) void restart();
    }),
    vscode.workspace.onDidGrantWorkspaceTrust(() => void restart()),
  );
  await restart();
}

export async function deactivate(): Promise<void> {
  await queue;
  await stop();
}

function restart(): Promise<void> {
  queue = queue.then(stop).then(start).catch(failed);
  return queue;
}

async function stop(): Promise<void> {
  const old = client;
  client = undefined;
  if (old?.needsStop()) await old.stop().catch(() => undefined);
  await old?.dispose().catch(() => undefined);
}

async function start(): Promise<void> {
  const settings = vscode.workspace.getConfiguration("dosmc");
  const setting = settings.get<string>("path", "dosmc");
  const found = findProgram(setting, surroundings());
  if ("looked" in found) {
    log.error(`${notFound(setting, found.looked)} Looked for:\n${found.looked.join("\n")}`);
    return missing(notFound(setting, found.looked));
  }
  const environment = { ...process.env, ...settings.get<Record<string, string>>("environment", {}) };
  const given = settings.get<string[]>("arguments", []);
  const server: Executable = { command: found.program, args: ["lsp", ...given], options: { env: environment } };
  const options: LanguageClientOptions = {
    documentSelector: [
      { scheme: "file", language: "dosm" },
      { scheme: "untitled", language: "dosm" },
    ],
    diagnosticCollectionName: "dosmc",
    outputChannel: log,
    revealOutputChannelOn: RevealOutputChannelOn.Never,
    // It is said below, with what can be done.
    initializationFailedHandler: () => false,
    middleware: {
      window: {
        // Pictures open beside the mission; other programs show the rest.
        showDocument: async (asked, next) => {
          if (asked.external && asked.uri.endsWith(".svg")) {
            showPicture(vscode.Uri.parse(asked.uri));
            return { success: true };
          }
          const answer = await next(asked, new vscode.CancellationTokenSource().token);
          return "success" in answer ? answer : { success: false };
        },
      },
    },
  };
  log.info(`starting ${[server.command, ...(server.args ?? [])].join(" ")}`);
  client = new LanguageClient("dosmc", "dosmc", { run: server, debug: server }, options);
  client.onDidChangeState(({ newState }) => show(newState, found.program));
  await client.start();
}

function surroundings(): Surroundings {
  const windows = process.platform === "win32";
  return {
    home: os.homedir(),
    workspace: vscode.workspace.workspaceFolders?.[0]?.uri.fsPath,
    path: process.env.PATH ?? "",
    endings: windows ? [".exe", ""] : [""],
  };
}

/** Shows in the status of the language how the server is. */
function show(state: State, program: string): void {
  item.busy = state === State.Starting;
  item.severity =
    state === State.Stopped ? vscode.LanguageStatusSeverity.Error : vscode.LanguageStatusSeverity.Information;
  const version = client?.initializeResult?.serverInfo?.version;
  const states = { [State.Running]: version ? `dosmc ${version}` : "dosmc", [State.Starting]: "dosmc starts" };
  item.text = state === State.Stopped ? "dosmc does not run" : states[state];
  item.detail = program;
}

/** Says that there is no server, and offers what helps. */
async function missing(why: string): Promise<void> {
  item.severity = vscode.LanguageStatusSeverity.Warning;
  item.text = "dosmc not found";
  item.detail = why;
  // Not waited for: the message stays until somebody answers.
  void offer(`${why} ${HOW_TO_INSTALL} Highlighting and snippets work without it.`);
}

async function failed(error: unknown): Promise<void> {
  const why = error instanceof Error ? error.message : String(error);
  log.error(why);
  void offer(`The language server did not start: ${why}`);
}

async function offer(message: string): Promise<void> {
  const settings = "Open the setting";
  const again = "Try again";
  const answer = await vscode.window.showErrorMessage(message, settings, again, "Show log");
  if (answer === settings) await vscode.commands.executeCommand("workbench.action.openSettings", "dosmc.path");
  else if (answer === again) await restart();
  else if (answer !== undefined) log.show();
}

/** Asks the server for something about the mission in the active editor. */
async function ask(command: string): Promise<unknown> {
  const editor = vscode.window.activeTextEditor;
  if (editor?.document.languageId !== "dosm") {
    return vscode.window.showInformationMessage("Open a mission (.dosm) first.");
  }
  await queue;
  if (!client?.isRunning()) {
    return offer("The language server does not run.");
  }
  const uri = client.code2ProtocolConverter.asUri(editor.document.uri);
  try {
    return await client.sendRequest("workspace/executeCommand", { command, arguments: [uri] });
  } catch (error) {
    return vscode.window.showWarningMessage(error instanceof Error ? error.message : String(error));
  }
}
