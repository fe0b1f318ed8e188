// SPDX-License-Identifier: Apache-2.0
// A React 19 page, which a server can render too.
import "@vitrine/progressive-mesh/element";
import type { ProgressiveMeshElement } from "@vitrine/progressive-mesh/element";
import { useRef, useState } from "react";

export function Bust({ src }: { src: string }) {
  const viewer = useRef<ProgressiveMeshElement>(null);
  const [triangles, setTriangles] = useState(0);
  return (
    <main data-triangles={triangles}>
      <progressive-mesh ref={viewer} src={src} alt="A bust" camera-controls pixel-error={0}
        onrefine={({ detail }) => setTriangles(detail.triangles)} />
    </main>
  );
}

// @ts-expect-error: the viewer has no such transport
export const wrong = <progressive-mesh transport="pigeon" />;
