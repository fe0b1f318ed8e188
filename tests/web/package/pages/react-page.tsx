// SPDX-License-Identifier: Apache-2.0
import { createRoot } from "react-dom/client";
import { Bust } from "./react.tsx";

createRoot(document.body.appendChild(document.createElement("div"))).render(<Bust src="/model.pmesh" />);
