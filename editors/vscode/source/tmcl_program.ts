// The program `tmcl`, which does all that this extension only shows.
import { constants } from 'node:fs';
import { access, stat } from 'node:fs/promises';
import { homedir } from 'node:os';
import { delimiter, isAbsolute, join, sep } from 'node:path';
import * as vscode from 'vscode';

const settingsOfThisExtension = '@ext:opentmcl.opentmcl';

async function isProgram(path: string): Promise<boolean> {
  try {
    await access(path, constants.X_OK);
    return (await stat(path)).isFile();
  } catch {
    return false; // Not there, or not to be executed: the same to the one who looks for a program.
  }
}

/** Where a program may be: a path as it stands, from home or from the workspace; a name in each folder of PATH. */
function places(name: string): string[] {
  if (name.startsWith('~/')) return [join(homedir(), name.slice(2))];
  if (isAbsolute(name)) return [name];
  if (name.includes('/') || name.includes(sep)) {
    return (vscode.workspace.workspaceFolders ?? []).map((folder) => join(folder.uri.fsPath, name));
  }
  const folders = (process.env['PATH'] ?? '').split(delimiter).filter((folder) => folder !== '');
  const names = process.platform === 'win32' ? [`${name}.exe`, name] : [name];
  return folders.flatMap((folder) => names.map((each) => join(folder, each)));
}

/** The path of `tmcl` by the setting tmcl.path; undefined when it is not there. */
export async function findTmcl(): Promise<string | undefined> {
  const name = vscode.workspace.getConfiguration('tmcl').get<string>('path', 'tmcl');
  for (const place of places(name)) {
    if (await isProgram(place)) return place;
  }
  return undefined;
}

/** Says that `tmcl` is not there, and what to do. */
export async function reportMissingTmcl(): Promise<void> {
  const name = vscode.workspace.getConfiguration('tmcl').get<string>('path', 'tmcl');
  const openSettings = 'Open Settings';
  const answer = await vscode.window.showErrorMessage(
    `TMCL: the program '${name}' was not found, so there are colours and snippets only. ` +
      "Build OpenTMCL with './run --build-only' and set 'tmcl.path' to its build/release/tmcl.",
    openSettings,
  );
  if (answer === openSettings) {
    await vscode.commands.executeCommand('workbench.action.openSettings', `${settingsOfThisExtension} tmcl.path`);
  }
}
