// SPDX-License-Identifier: Apache-2.0
// Explains failures that are caused by a Content-Security-Policy. The browser does not tell the
// failing call the cause, but reports the cause in an event.

interface Violation {
  blockedURI: string;
  effectiveDirective: string;
}

export class PolicyWatch {
  #seen: Violation | undefined;

  /**
   * Watches a page or a worker for violations of `directives`. If no directives are given, watches
   * for violations of all directives.
   */
  constructor(scope: EventTarget, directives?: string[]) {
    scope.addEventListener("securitypolicyviolation", (event) => {
      const violation = event as Event & Violation;
      // A blocked WebSocket is not fatal, because the viewer then uses HTTP.
      if (!violation.blockedURI.startsWith("ws") && (directives?.includes(violation.effectiveDirective) ?? true)) this.#seen = violation;
    });
  }

  /**
   * Resolves to a description of the violation seen so far and of how to permit the blocked action,
   * or to undefined. Waits for one task, because browsers report a violation only in a task after
   * the failure.
   */
  async reason(): Promise<string | undefined> {
    await new Promise((resolve) => setTimeout(resolve));
    if (!this.#seen) return undefined;
    const { blockedURI, effectiveDirective } = this.#seen;
    const source = sourceOf(blockedURI);
    const directive = effectiveDirective.replace(/-elem$/, "");
    return `the page's Content-Security-Policy forbids ${blockedURI}: add ${source} to ${directive}`;
  }
}

/** Returns the source expression with which a policy permits `blockedURI`. */
function sourceOf(blockedURI: string): string {
  if (blockedURI === "wasm-eval") return "'wasm-unsafe-eval'";
  if (!blockedURI.includes(":")) return `${blockedURI}:`; // a scheme such as "blob" or "data"
  const { origin } = new URL(blockedURI);
  return origin === location.origin ? "'self'" : origin;
}
