// A .vsix is a zip file in the Open Packaging Conventions: the files of the extension below extension/, a manifest for the
// gallery, and a list of content types.
import { zipSync } from 'fflate';

const contentTypes = {
  js: 'application/javascript',
  json: 'application/json',
  md: 'text/markdown',
  txt: 'text/plain',
  vsixmanifest: 'text/xml',
};

/** The same files give the same bytes, whenever they are packed. */
const timeInTheArchive = new Date(2000, 0, 1);

function escaped(text) {
  return text.replace(/[&<>"]/g, (sign) => ({ '&': '&amp;', '<': '&lt;', '>': '&gt;', '"': '&quot;' })[sign]);
}

function manifestOf(extension, files) {
  const asset = (type, path) => `    <Asset Type="${type}" Path="extension/${path}" Addressable="true"/>`;
  const assets = [asset('Microsoft.VisualStudio.Code.Manifest', 'package.json')];
  if (files.has('README.md')) assets.push(asset('Microsoft.VisualStudio.Services.Content.Details', 'README.md'));
  if (files.has('LICENSE.txt')) assets.push(asset('Microsoft.VisualStudio.Services.Content.License', 'LICENSE.txt'));
  return `<?xml version="1.0" encoding="utf-8"?>
<PackageManifest Version="2.0.0" xmlns="http://schemas.microsoft.com/developer/vsx-schema/2011" xmlns:d="http://schemas.microsoft.com/developer/vsx-schema-design/2011">
  <Metadata>
    <Identity Language="en-US" Id="${escaped(extension.name)}" Version="${escaped(extension.version)}" Publisher="${escaped(extension.publisher)}"/>
    <DisplayName>${escaped(extension.displayName)}</DisplayName>
    <Description xml:space="preserve">${escaped(extension.description)}</Description>
    <Tags>${escaped(extension.keywords.join(','))}</Tags>
    <Categories>${escaped(extension.categories.join(','))}</Categories>
    <GalleryFlags>Public</GalleryFlags>
    <Properties>
      <Property Id="Microsoft.VisualStudio.Code.Engine" Value="${escaped(extension.engines.vscode)}"/>
      <Property Id="Microsoft.VisualStudio.Code.ExtensionDependencies" Value=""/>
      <Property Id="Microsoft.VisualStudio.Code.ExtensionPack" Value=""/>
      <Property Id="Microsoft.VisualStudio.Code.ExtensionKind" Value="workspace"/>
      <Property Id="Microsoft.VisualStudio.Code.LocalizedLanguages" Value=""/>
    </Properties>
    <License>extension/LICENSE.txt</License>
  </Metadata>
  <Installation>
    <InstallationTarget Id="Microsoft.VisualStudio.Code"/>
  </Installation>
  <Dependencies/>
  <Assets>
${assets.join('\n')}
  </Assets>
</PackageManifest>
`;
}

function contentTypesOf(paths) {
  const extensions = [...new Set(paths.map((path) => path.slice(path.lastIndexOf('.') + 1)))].sort();
  const rows = extensions.map((extension) => {
    const type = contentTypes[extension];
    if (type === undefined) throw new Error(`no content type is known for .${extension}: add it in scripts/vsix.mjs`);
    return `  <Default Extension=".${extension}" ContentType="${type}"/>`;
  });
  return `<?xml version="1.0" encoding="utf-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
${rows.join('\n')}
</Types>
`;
}

/** `extension` is its package.json as an object, `files` a map of paths to bytes. */
export function vsixOf(extension, files) {
  const text = (content) => new TextEncoder().encode(content);
  const archive = { 'extension.vsixmanifest': text(manifestOf(extension, files)) };
  for (const path of [...files.keys()].sort()) archive[`extension/${path}`] = files.get(path);
  archive['[Content_Types].xml'] = text(contentTypesOf(Object.keys(archive)));
  return zipSync(archive, { level: 9, mtime: timeInTheArchive });
}
