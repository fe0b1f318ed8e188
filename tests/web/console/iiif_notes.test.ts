// SPDX-License-Identifier: Apache-2.0
import { inFile, readNoteFile } from "@console/iiif-notes.ts";

const kHalf = Math.SQRT1_2;
const plain = { presentation: { rotation: [0, 0, 0, 1] as [number, number, number, number], scale: 1 }, unit: "" };
const read = (json: unknown, scale = plain) => readNoteFile(typeof json === "string" ? json : JSON.stringify(json), scale, () => "new", "no notes");
const annotation = (more = {}) => ({
  label: { en: ["Ear"], de: ["Ohr"] },
  body: [{ type: "TextualBody", language: "en", value: "In plaster." }, { type: "TextualBody", language: "de", value: "Ohr" }, { type: "Image", id: "https://a/b.jpg" },
    { type: "Sound", language: "de", id: "https://a/o.mp3" }],
  target: { selector: [{ type: "PointSelector", x: 0.1, y: 0.2, z: 0.3 }] }, ...more,
});
const page = (...items: unknown[]) => ({ type: "AnnotationPage", items });

test("a saved file is read whole", () => {
  const file = { notes: [{ id: "a", position: [1, 2, 3], texts: { en: { title: "A" } } }], tours: [] };
  expect(read(file)).toEqual({ ...file, isWhole: true });
});

test("annotations become notes", () => expect(read(page(annotation()))).toEqual({
  notes: [{ id: "new", position: [0.1, 0.2, 0.3], picture: "https://a/b.jpg", texts: { en: { title: "Ear", text: "In plaster." }, de: { title: "Ohr", audio: "https://a/o.mp3" } } }],
  tours: [], isWhole: false,
}));

test("an annotation without a label has the first line as its title", () => {
  const { notes } = read(page(annotation({ label: undefined, body: { type: "TextualBody", value: "Ear\n\nIn plaster." } })));
  expect(notes[0]?.texts).toEqual({ en: { title: "Ear", text: "In plaster." } });
});

test.each(["{", "[]", "null", page(), page(annotation({ target: "https://a/canvas" })), { type: "Manifest", items: [] }])("%j has no notes", (json) => expect(() => read(json)).toThrow("no notes"));

test("a long first line is cut to a title, and kept as text", () => {
  const textOf = (value: string, label?: object) => read(page(annotation({ label, body: { type: "TextualBody", value } }))).notes[0]?.texts["en"];
  const line = "a".repeat(300), faces = "\u{1F600}".repeat(60);
  expect(textOf(`${line}\nMore.`)).toEqual({ title: "a".repeat(200), text: `${line}\nMore.` });
  expect(textOf(`x${faces}`)).toEqual({ title: `x${"\u{1F600}".repeat(49)}`, text: `x${faces}` });
  expect(textOf("é".repeat(100))).toEqual({ title: "é".repeat(100), text: "" });
  expect(textOf("More.", { en: [line] })).toEqual({ title: "a".repeat(200), text: `${line}\n\nMore.` });
  expect(textOf(line, { en: [line] })).toEqual({ title: "a".repeat(200), text: line });
});

const note = { id: "a", position: [1, 2, 3], texts: { en: { title: "A" } } };
const tour = { id: "t", titles: { en: "T" }, steps: [{ note: "a" }] };

test.each([
  { ...note, id: 1 }, { ...note, position: [1, 2] }, { ...note, position: [1, 2, "3"] }, { ...note, texts: {} }, { ...note, texts: { en: null } }, { ...note, texts: { en: { text: "A" } } },
  { ...note, texts: undefined }, { ...note, view: {} }, null, "note",
])("the note %j is refused", (malformed) => expect(() => read({ notes: [note, malformed] })).toThrow("no notes"));

test.each([{ ...tour, titles: {} }, { ...tour, titles: null }, { ...tour, steps: undefined }, { ...tour, steps: [null] }, { ...tour, steps: [{}] }, null])("the tour %j is refused", (malformed) =>
  expect(() => read({ notes: [note], tours: [tour, malformed] })).toThrow("no notes"));

test("tours that are no list are refused, and may be missing", () => {
  expect(() => read({ notes: [note], tours: {} })).toThrow("no notes");
  expect(read({ notes: [note] }).tours).toEqual([]);
});

test.each([null, annotation({ label: null }), annotation({ label: { en: null } }), annotation({ body: { type: "TextualBody", value: 1 } }), annotation({ body: [null] }), annotation({ target: null }),
  annotation({ target: { selector: [null] } }), annotation({ target: { selector: { type: "PointSelector", x: "1", y: 2, z: 3 } } })])("the annotation %j is refused", (malformed) =>
  expect(() => read(page(annotation(), malformed))).toThrow("no notes"));

test("line ends and tabs become what the daemon takes", () => {
  const { notes } = read(page(annotation({ label: { en: ["An\tear"] }, body: { type: "TextualBody", value: "One\r\ntwo\tthree\r", language: "en" } })));
  expect(notes[0]!.texts.en).toEqual({ title: "An ear", text: "One\ntwo three\n" });
});

test("points of the scene are turned and scaled back to the file", () => {
  // The presentation turns z up to y up and takes inches as file units; the scene is in metres.
  const scale = { presentation: { rotation: [-kHalf, 0, 0, kHalf] as [number, number, number, number], scale: 25.4 }, unit: "mm" };
  const [x, y, z] = inFile([1 * 0.0254, 3 * 0.0254, -2 * 0.0254], scale);
  expect(x).toBeCloseTo(1);
  expect(y).toBeCloseTo(2);
  expect(z).toBeCloseTo(3);
});
