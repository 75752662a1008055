// The extension, packed once for all tests of a file.
import { readFileSync } from 'node:fs';
import { unzipSync } from 'fflate';
import { makePackage } from '../scripts/package.mjs';

/** The vsix as a map of paths to texts. */
export async function unpackedExtension() {
  const vsix = await makePackage();
  const files = unzipSync(readFileSync(vsix));
  return new Map(Object.entries(files).map(([path, bytes]) => [path, new TextDecoder().decode(bytes)]));
}
