// SPDX-License-Identifier: Apache-2.0
import { routed } from "@console/router.ts";

const routes = [["scans", "list"], ["scans/new", "new"], ["scans/:id", "one"], ["scanners/:name/calibrate", "wizard"]] as const;

test.each([
  ["#/scans", "list", []],
  ["#/scans/new", "new", []],
  ["#/scans/01hf", "one", ["01hf"]],
  ["#/scanners/my%20rig/calibrate", "wizard", ["my rig"]],
])("%s is %s", (hash, target, words) => expect(routed(routes, hash)).toEqual({ target, words }));

test.each(["", "#/", "#/nothing", "#/scans/", "#/scans/a/b"])("%s is no page", (hash) => expect(routed(routes, hash)).toBeNull());
