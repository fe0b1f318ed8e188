// SPDX-License-Identifier: Apache-2.0
import { createApp } from "vue";
import Bust from "./Bust.vue";

createApp(Bust).mount(document.body.appendChild(document.createElement("div")));
