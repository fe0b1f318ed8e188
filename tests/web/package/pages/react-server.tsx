// SPDX-License-Identifier: Apache-2.0
import { renderToString } from "react-dom/server";
import { Bust } from "./react.tsx";

export const html = renderToString(<Bust src="/model.pmesh" />);
