// The client of `tmcl lsp`.
import * as vscode from 'vscode';
import { LanguageClient, TransportKind } from 'vscode-languageclient/node';
import { findTmcl, reportMissingTmcl } from './tmcl_program';

export class TmclLanguageClient {
  private client: LanguageClient | undefined;
  /** Starts and stops come one after the other, however fast they are asked for. */
  private last: Promise<void> = Promise.resolve();

  restart(): Promise<void> {
    return this.afterTheLast(async () => {
      await this.stopNow();
      await this.startNow();
    });
  }

  stop(): Promise<void> {
    return this.afterTheLast(() => this.stopNow());
  }

  private afterTheLast(action: () => Promise<void>): Promise<void> {
    this.last = this.last.then(action, action);
    return this.last;
  }

  private async startNow(): Promise<void> {
    const program = await findTmcl();
    if (program === undefined) {
      // Not awaited: the message stays until somebody reads it.
      void reportMissingTmcl();
      return;
    }
    const server = { command: program, args: ['lsp'], transport: TransportKind.stdio };
    const client = new LanguageClient('tmcl', 'TMCL', server, {
      documentSelector: [{ language: 'tmcl' }],
      initializationOptions: { module: vscode.workspace.getConfiguration('tmcl').get<string>('module', 'pd1161') },
      synchronize: { configurationSection: 'tmcl' },
    });
    this.client = client;
    try {
      await client.start();
    } catch (error) {
      this.client = undefined;
      void vscode.window.showErrorMessage(
        `TMCL: '${program} lsp' does not start (${String(error)}). Is it a version of OpenTMCL with a language server?`,
      );
    }
  }

  private async stopNow(): Promise<void> {
    const client = this.client;
    this.client = undefined;
    await client?.stop();
  }
}
