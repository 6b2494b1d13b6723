// The picture of a plan, beside the mission.

import * as path from "node:path";
import * as vscode from "vscode";

const panels = new Map<string, vscode.WebviewPanel>();

/** Shows an SVG file in the editor, anew where it is shown already. */
export function showPicture(file: vscode.Uri): void {
  const key = file.toString();
  const panel = panels.get(key) ?? open(file, key);
  panel.webview.html = page(panel.webview, file);
  panel.reveal(undefined, true);
}

function open(file: vscode.Uri, key: string): vscode.WebviewPanel {
  const place = { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true };
  const title = path.basename(path.dirname(file.fsPath));
  const folder = vscode.Uri.joinPath(file, "..");
  const panel = vscode.window.createWebviewPanel("dosm.picture", title, place, { localResourceRoots: [folder] });
  panel.onDidDispose(() => panels.delete(key));
  panels.set(key, panel);
  return panel;
}

/** The page around the picture; nothing in it runs. */
function page(webview: vscode.Webview, file: vscode.Uri): string {
  // Another address each time, so that a new plan's picture is not the old one's.
  const address = webview.asWebviewUri(file).with({ query: `at=${Date.now()}` }).toString();
  const policy = `default-src 'none'; img-src ${webview.cspSource}; style-src 'unsafe-inline'`;
  return `<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="${policy}">
<style>body { margin: 0; background: white } img { display: block; margin: auto; max-width: 100%; max-height: 100vh }</style>
</head>
<body><img src="${address}" alt="The plan's picture"></body>
</html>`;
}
