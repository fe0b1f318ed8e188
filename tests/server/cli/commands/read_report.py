#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""read_report.py PAGE: prints the content of a page of `vitrine build --report` as JSON. Fails if it is not XML."""
import json
import sys
import xml.etree.ElementTree as ElementTree

page = ElementTree.parse(sys.argv[1]).getroot()
rows = [[float(number.get("value")) for number in row.iter("data")] for row in page.iter("tr")]
print(json.dumps({
    "title": page.findtext("head/title"),
    "heading": "".join(page.find("body/main/header/h1").itertext()),
    "levels": [row for row in rows if row],
    "marks": len([mark for mark in page.iter("circle") if mark.find("title") is not None]),
    "pictures": [picture.get("src")[:22] for picture in page.iter("img")],
    "links": [value for element in page.iter() for name, value in element.items()
              if name in ("src", "href", "srcset", "data", "action") and not value.startswith("data:image/png")],
    "scripts": [element.tag for element in page.iter()
                if element.tag in ("script", "iframe", "object", "embed", "link")
                or any(name.startswith("on") for name in element.keys())],
    "text": "\n".join(page.find("body").itertext()),
}))
