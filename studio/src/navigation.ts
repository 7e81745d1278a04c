// The two views of the page, as links.
import { h } from "./dom";

const VIEWS = [
  ["read", "#read", "Read"],
  ["release", "#", "One release"],
] as const;
export type ViewName = (typeof VIEWS)[number][0];

export function navigation(current: ViewName): HTMLElement {
  return h(
    "nav",
    { "aria-label": "views" },
    ...VIEWS.map(([name, href, text]) =>
      h("a", { href, "aria-current": name === current ? "page" : null }, text),
    ),
  );
}
