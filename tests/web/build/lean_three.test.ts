// SPDX-License-Identifier: Apache-2.0
import { shortShader, withoutUnused } from "../../../web/lean_three.mjs";

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

describe("withoutUnused", () => {
  const lines = (...glsl: string[]) => glsl.join("\n");

  test("removes branches for features that no material has, and keeps the other branches", () => {
    expect(withoutUnused(lines("a", "#ifdef USE_SHEEN", "b", "#else", "c", "#endif", "#ifndef USE_FOG", "d", "#else", "e", "#endif"))).toBe("a\nc\nd");
    expect(withoutUnused(lines("#ifdef USE_SKINNING", "#ifdef USE_MAP", "a", "#else", "b", "#endif", "c", "#endif", "d"))).toBe("d");
  });

  test("keeps conditions for other features", () => {
    const kept = lines("#ifdef USE_MAP", "a", "#elif defined( USE_COLOR )", "b", "#else", "c", "#endif", "#if ! defined( USE_FOG )", "d", "#endif");
    expect(withoutUnused(kept)).toBe(kept);
  });

  test("makes the branch after a removed one the first", () => {
    expect(withoutUnused(lines("#if defined( USE_SHEEN )", "a", "#elif defined( USE_MAP )", "b", "#elif defined( USE_BUMPMAP )", "c", "#else", "d", "#endif")))
      .toBe(lines("#if defined( USE_MAP )", "b", "#else", "d", "#endif"));
  });

  test("removes a branch only if all alternatives of its condition are false", () => {
    const [or, and] = ["#if defined( USE_MAP ) || defined( USE_ALPHAMAP )", "#if ( NUM_SPOT_LIGHTS > 0 ) && defined( RE_Direct )"];
    expect(withoutUnused(lines(or, "a", "#endif"))).toBe(lines(or, "a", "#endif"));
    expect(withoutUnused(lines(and, "a", "#endif"))).toBe("");
    expect(withoutUnused(lines("#if ( defined( USE_SHADOWMAP ) && ( NUM_DIR_LIGHT_SHADOWS > 0 || NUM_POINT_LIGHT_SHADOWS > 0 ) )", "a", "#endif"))).toBe("");
  });
});
