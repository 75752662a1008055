import * as vscode from 'vscode';
import { TmclConfigurationProvider, TmclDebugAdapterFactory } from './debugging';
import { TmclLanguageClient } from './language_client';

const client = new TmclLanguageClient();

export async function activate(context: vscode.ExtensionContext): Promise<void> {
  const configurations = new TmclConfigurationProvider();
  context.subscriptions.push(
    vscode.commands.registerCommand('tmcl.restartServer', () => client.restart()),
    vscode.workspace.onDidChangeConfiguration(async (change) => {
      if (change.affectsConfiguration('tmcl.path')) await client.restart();
    }),
    vscode.debug.registerDebugAdapterDescriptorFactory('tmcl', new TmclDebugAdapterFactory()),
    vscode.debug.registerDebugConfigurationProvider('tmcl', configurations),
    vscode.debug.registerDebugConfigurationProvider(
      'tmcl',
      configurations,
      vscode.DebugConfigurationProviderTriggerKind.Dynamic,
    ),
  );
  await client.restart();
}

export function deactivate(): Promise<void> {
  return client.stop();
}
