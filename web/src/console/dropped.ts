// SPDX-License-Identifier: Apache-2.0
// Turns the files and folders that an operator drops into uploads. A model and the files that it
// names, such as pictures, become one upload: a tar file.
import { isMeshName, isUploadName } from "./mesh-formats.ts";
import { tarOf } from "./tar.ts";

export interface Dropped {
  /** Path from the dropped folder, such as "bust/bust.obj"; only the name if a file was dropped. */
  path: string;
  file: File;
}

/** Returns the dropped files, and all files in the dropped folders. */
export async function droppedFiles(transfer: DataTransfer): Promise<Dropped[]> {
  // The browser empties `transfer` at the first `await`, so all items must be read before that.
  const found = [...transfer.items].map((item) => ({ entry: item.webkitGetAsEntry(), file: item.getAsFile() }));
  const lists = found.map(async ({ entry, file }) => (entry?.isDirectory ? below(entry as FileSystemDirectoryEntry) : file ? [{ path: file.name, file }] : []));
  return (await Promise.all(lists)).flat();
}

async function below(folder: FileSystemDirectoryEntry): Promise<Dropped[]> {
  const lists = (await entriesOf(folder)).map(async (entry) => {
    if (entry.isDirectory) return below(entry as FileSystemDirectoryEntry);
    const file = await new Promise<File>((resolve, reject) => (entry as FileSystemFileEntry).file(resolve, reject));
    return [{ path: entry.fullPath.replace(/^\//, ""), file }];
  });
  return (await Promise.all(lists)).flat();
}

/** Returns the entries of a folder. Some browsers read at most 100 entries per call. */
async function entriesOf(folder: FileSystemDirectoryEntry): Promise<FileSystemEntry[]> {
  const reader = folder.createReader(), all: FileSystemEntry[] = [];
  for (;;) {
    const some = await new Promise<FileSystemEntry[]>((resolve, reject) => reader.readEntries(resolve, reject));
    if (some.length === 0) return all;
    all.push(...some);
  }
}

const isHidden = ({ path }: Dropped): boolean => path.split("/").some((part) => part.startsWith("."));

/**
 * Returns the files to upload. If files other than models and packages were dropped, each model
 * becomes a tar file that also contains all of these other files. Dropping the same files again
 * gives the same tar, so that an interrupted upload can be resumed.
 */
export function uploadsOf(dropped: Dropped[]): File[] {
  const seen = dropped.filter((one) => !isHidden(one)).sort((a, b) => (a.path < b.path ? -1 : 1));
  const models = seen.filter(({ path }) => isMeshName(path)), beside = seen.filter(({ path }) => !isUploadName(path));
  if (models.length === 0 || beside.length === 0) return seen.map(({ file }) => file);
  const packages = seen.filter(({ path }) => isUploadName(path) && !isMeshName(path));
  return [...models.map((model) => packed(model, beside)), ...packages.map(({ file }) => file)];
}

function packed(model: Dropped, beside: Dropped[]): File {
  const { name, lastModified } = model.file;
  return new File([tarOf([model, ...beside])], `${name.replace(/\.[^.]+$/, "")}.tar`, { lastModified, type: "application/x-tar" });
}
