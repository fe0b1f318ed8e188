// SPDX-License-Identifier: Apache-2.0
import { inLanguage, languageIn, lightOf, type StoredNote } from "@element/notes/annotations.ts";
import { paragraphsOf, secondsToRead } from "@element/notes/paragraphs.ts";
import { isSounding } from "@element/notes/tour-player.ts";

test("empty lines separate paragraphs, and links have labels", () => {
  expect(paragraphsOf("One,\ntwo.\r\n\r\nSee [the file](https://a.example/b?c=d), [and](http://b).\n\n\n")).toEqual([
    ["One,\ntwo."], ["See ", { label: "the file", url: "https://a.example/b?c=d" }, ", ", { label: "and", url: "http://b" }, "."],
  ]);
  expect(paragraphsOf("")).toEqual([]);
});

test.each(["[a](javascript:alert(1))", "[a](/b)", "<b>bold</b>", "[a] (https://b)"])("'%s' stays a text", (text) => expect(paragraphsOf(text)).toEqual([[text]]));

test.each([["de", "de"], ["de-CH", "de"], ["en-GB", "en-GB"], ["fr", "en-GB"], ["", "en-GB"]])("a visitor of language '%s' reads %s", (wanted, tag) =>
  expect(languageIn({ de: 1, "en-GB": 1, it: 1 }, wanted)).toBe(tag));

test("without English, the first language is shown, and nothing without any", () => {
  expect(languageIn({ it: 1, es: 1 }, "fr")).toBe("it");
  expect(languageIn({}, "fr")).toBeUndefined();
});

test("a note is shown in the language of the page", () => {
  const note: StoredNote = { id: "a", position: [1, 2, 3], texts: { en: { title: "Ear", text: "Plaster" }, de: { title: "Ohr", audio: "/o.mp3" } }, light: "raking,45", section: "" };
  expect(inLanguage(note, "de-AT", undefined)).toMatchObject({ title: "Ohr", text: "", audio: "/o.mp3", language: "de", light: "raking,45", section: "" });
  expect(inLanguage(note, "fr", undefined)).toMatchObject({ title: "Ear", text: "Plaster", language: "en" });
});

test("paths of pictures and sounds are those of the daemon", () => {
  const note: StoredNote = { id: "a", position: [1, 2, 3], picture: "/files/ear.jpg", texts: { en: { title: "Ear", audio: "/files/ear.mp3" }, de: { title: "Ohr", audio: "https://other.example/o.mp3" } } };
  const api = "https://daemon.example/scans/api/v1/models/1";
  expect(inLanguage(note, "en", api)).toMatchObject({ picture: "https://daemon.example/files/ear.jpg", audio: "https://daemon.example/files/ear.mp3" });
  expect(inLanguage(note, "de", api).audio).toBe("https://other.example/o.mp3");
  expect(inLanguage({ ...note, picture: "https://[" }, "en", api).picture).toBe("https://[");
});

test("a note keeps the light that is shown", () => {
  expect(lightOf(null)).toBe("museum");
  expect(lightOf({ preset: "raking", angle: 45 })).toBe("raking,45");
  expect(lightOf({ preset: "studio", angle: 315 })).toBe("studio");
});

test("a tour leaves time to read", () => {
  expect(secondsToRead("Ear", "")).toBe(5);
  expect(secondsToRead("Ear", "word ".repeat(99))).toBe(43);
  expect(secondsToRead("word ".repeat(1000))).toBe(60);
});

test("a tour waits only for a sound that plays", () => {
  const sound = { paused: false, ended: false, error: null };
  expect(isSounding(sound)).toBe(true);
  expect(isSounding({ ...sound, paused: true })).toBe(false);
  expect(isSounding({ ...sound, ended: true })).toBe(false);
  expect(isSounding({ ...sound, error: {} as MediaError })).toBe(false);
});
