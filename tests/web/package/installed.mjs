// SPDX-License-Identifier: Apache-2.0
// Packs the npm package as it would be published, and installs it in a temporary folder. Links the
// folder's other packages from this test's node_modules, which has pinned versions.
import { execFileSync } from "node:child_process";
import { cpSync, mkdirSync, mkdtempSync, readdirSync, rmSync, symlinkSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

export const web = fileURLToPath(new URL("../../../web/", import.meta.url));
const here = fileURLToPath(new URL("./", import.meta.url));

export class Installed {
  #home = mkdtempSync(join(tmpdir(), "vitrine-package-"));
  folder = join(this.#home, "project");

  constructor() {
    const [{ filename, files }] = JSON.parse(
      execFileSync("npm", ["pack", "--json", "--silent", "--pack-destination", this.#home], { cwd: web, encoding: "utf8" }));
    this.paths = files.map(({ path }) => path);
    this.archive = join(this.#home, filename);
    this.package = this.#unpack(this.folder, readdirSync(join(here, "node_modules")).filter((name) => !name.startsWith(".vite")));
    cpSync(join(here, "pages"), join(this.folder, "pages"), { recursive: true });
  }

  /** Returns a new folder with the package, the program user.ts and only the given packages. */
  bare(...packages) {
    const folder = join(this.#home, "bare");
    this.#unpack(folder, packages);
    cpSync(join(here, "pages/user.ts"), join(folder, "user.ts"));
    return folder;
  }

  /**
   * Unpacks the package into the folder's node_modules and creates symbolic links there to the
   * packages `others`. Returns the package's folder.
   */
  #unpack(folder, others) {
    const modules = join(folder, "node_modules"), unpacked = join(modules, "@vitrine/progressive-mesh");
    mkdirSync(unpacked, { recursive: true });
    execFileSync("tar", ["-xzf", this.archive, "-C", unpacked, "--strip-components=1"]);
    for (const name of others) {
      mkdirSync(dirname(join(modules, name)), { recursive: true });
      symlinkSync(join(here, "node_modules", name), join(modules, name));
    }
    return unpacked;
  }

  /**
   * Runs a program of the installed packages in the project's folder. Throws if the program fails.
   * Returns its output.
   */
  run(program, ...args) {
    return execFileSync(join(here, "node_modules/.bin", program), args, { cwd: this.folder, encoding: "utf8", stdio: ["ignore", "pipe", "inherit"] });
  }

  remove() {
    rmSync(this.#home, { recursive: true, force: true });
  }
}
