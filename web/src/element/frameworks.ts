// SPDX-License-Identifier: Apache-2.0
// Types of <progressive-mesh> in JSX of React 19 and in templates of Vue 3. A program may use one
// of the two frameworks or neither. The lines that need a framework's own types are therefore
// ignored if the framework is not installed. Only comments of the form /** remain in the published
// types.
import type { ProgressiveMeshAttributes, ProgressiveMeshElementEventMap as EventMap } from "./element-types.ts";
import type { ProgressiveMeshElement } from "./progressive-mesh-element.ts";

type Camel<S extends string> = S extends `${infer A}-${infer B}` ? `${A}${Capitalize<Camel<B>>}` : S;
/** React 19 listens for the event "first-paint" with the property "onfirst-paint". */
type ReactListeners = { [K in keyof EventMap as `on${K}`]?: ((event: EventMap[K]) => void) | undefined };
/** Vue listens for the event "first-paint" with the property "onFirstPaint", written as @first-paint. */
type VueListeners = { [K in keyof EventMap as `on${Capitalize<Camel<K>>}`]?: ((event: EventMap[K]) => void) | undefined };

/** @ts-ignore: absent without React */
type ReactHtml = import("react").DetailedHTMLProps<import("react").HTMLAttributes<ProgressiveMeshElement>, ProgressiveMeshElement>;
/** @ts-ignore: absent without Vue */
type VueHtml = Omit<import("vue").HTMLAttributes & import("vue").VNodeProps, keyof VueListeners>;

export type ReactProgressiveMeshProps = ReactHtml & ProgressiveMeshAttributes & ReactListeners;
export type VueProgressiveMeshProps = VueHtml & ProgressiveMeshAttributes & VueListeners;

/** @ts-ignore: absent without React */
declare module "react" {
  namespace JSX {
    interface IntrinsicElements {
      "progressive-mesh": ReactProgressiveMeshProps;
    }
  }
}

/** @ts-ignore: absent without Vue */
declare module "vue" {
  interface GlobalComponents {
    "progressive-mesh": new () => ProgressiveMeshElement & { $props: VueProgressiveMeshProps };
  }
}
