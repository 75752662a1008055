// Debugging by `tmcl dap`: which program to start, and what to debug when nobody has said so.
import * as vscode from 'vscode';
import { findTmcl, reportMissingTmcl } from './tmcl_program';

export class TmclDebugAdapterFactory implements vscode.DebugAdapterDescriptorFactory {
  async createDebugAdapterDescriptor(): Promise<vscode.DebugAdapterDescriptor | undefined> {
    const program = await findTmcl();
    if (program === undefined) {
      void reportMissingTmcl();
      return undefined;
    }
    return new vscode.DebugAdapterExecutable(program, ['dap']);
  }
}

const onVirtualModule: vscode.DebugConfiguration = {
  type: 'tmcl',
  request: 'launch',
  name: 'Debug on a virtual module',
  program: '${file}',
  stopOnEntry: true,
};

export class TmclConfigurationProvider implements vscode.DebugConfigurationProvider {
  provideDebugConfigurations(): vscode.DebugConfiguration[] {
    return [onVirtualModule];
  }

  /** F5 without a launch.json debugs the program in the editor, on a virtual module. */
  resolveDebugConfiguration(
    folder: vscode.WorkspaceFolder | undefined,
    given: vscode.DebugConfiguration,
  ): vscode.DebugConfiguration | undefined {
    const isEmpty = given.type === undefined || given.type === '';
    if (isEmpty && vscode.window.activeTextEditor?.document.languageId !== 'tmcl') return given;
    const configuration = isEmpty ? { ...onVirtualModule } : given;
    if (configuration['program'] === undefined) {
      void vscode.window.showErrorMessage(
        `TMCL: the configuration '${configuration.name}' has no 'program': ` +
          'write the path of a TMCL source there, or "${file}".',
      );
      return undefined;
    }
    // Below what the program's head and the module at a port say themselves, and so not `module`.
    configuration['defaultModule'] = vscode.workspace.getConfiguration('tmcl', folder).get<string>('module', 'pd1161');
    return configuration;
  }
}
