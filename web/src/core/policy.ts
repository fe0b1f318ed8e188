// SPDX-License-Identifier: Apache-2.0
// Explains failures that a Content-Security-Policy has caused. The browser hides the cause from the call that fails, and reports it in
// an event.

interface Violation {
  blockedURI: string;
  effectiveDirective: string;
}

export class PolicyWatch {
  #seen: Violation | undefined;

  /** Watches a page or a worker for violations of `directives`; without directives, of all. */
  constructor(scope: EventTarget, directives?: string[]) {
    scope.addEventListener("securitypolicyviolation", (event) => {
      const violation = event as Event & Violation;
      // A blocked WebSocket is not fatal, because the viewer then uses HTTP.
      if (!violation.blockedURI.startsWith("ws") && (directives?.includes(violation.effectiveDirective) ?? true)) this.#seen = violation;
    });
  }

  /**
   * Resolves to the violation seen so far and how to permit the act, or to undefined. Waits for one task, because browsers report a
   * violation in a task after that of the failure.
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

/** The source expression of a policy that permits `blockedURI`. */
function sourceOf(blockedURI: string): string {
  if (blockedURI === "wasm-eval") return "'wasm-unsafe-eval'";
  if (!blockedURI.includes(":")) return `${blockedURI}:`; // "blob" or "data"
  const { origin } = new URL(blockedURI);
  return origin === location.origin ? "'self'" : origin;
}
