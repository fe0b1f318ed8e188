// SPDX-License-Identifier: Apache-2.0
// Draws QR codes (ISO/IEC 18004) as SVG. The viewer loads this code when a visitor first asks for one.
import { generate } from "lean-qr";
import { toSvgPath } from "lean-qr/extras/svg";

const kSvg = "http://www.w3.org/2000/svg";

/** Width of the white margin, in squares of the code. Scanners need it. */
const kMargin = 4;

/** Returns a QR code of `text`, called `label` for screen readers. Throws if the text has more than 2,953 bytes. */
export function qrCode(text: string, label: string): SVGSVGElement {
  const code = generate(text), side = code.size + 2 * kMargin;
  const svg = document.createElementNS(kSvg, "svg"), path = document.createElementNS(kSvg, "path");
  for (const [name, value] of Object.entries({ viewBox: `${-kMargin} ${-kMargin} ${side} ${side}`, role: "img", "aria-label": label })) svg.setAttribute(name, value);
  path.setAttribute("d", toSvgPath(code));
  svg.append(path);
  return svg;
}
