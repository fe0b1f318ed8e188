// SPDX-License-Identifier: Apache-2.0
import { shortShader } from "../../../web/lean_three.mjs";

describe("shortShader", () => {
  test("removes comments, empty lines and blanks without meaning", () => {
    expect(shortShader("/* a\n   b */ float f ( vec3 a ) {\n\n\t// c\n\treturn a.x * 2. ; // d\n}")).toBe("float f(vec3 a){\nreturn a.x*2.;\n}");
  });

  test("keeps directives in lines of their own", () => {
    expect(shortShader("  #ifdef A\n\t#define B ( c, d )\n#endif\n  #include <common>")).toBe("#ifdef A\n#define B ( c, d )\n#endif\n#include <common>");
  });

  test("keeps blanks between signs, which would make another operator", () => {
    expect(shortShader("a = b - - c + + d;")).toBe("a=b - - c + + d;");
  });
});
