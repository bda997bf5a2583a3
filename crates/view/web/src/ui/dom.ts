// Elements made in one line.

type Child = Node | string | null | undefined;
type Attributes = Record<string, string | number | boolean | null | ((event: Event) => void)>;

/** An element; attributes that are functions are listeners, `true` and `false` set or leave out. */
export function element<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") made.addEventListener(name, value);
    else if (value === true) made.setAttribute(name, "");
    else if (value !== false && value !== null) made.setAttribute(name, String(value));
  }
  made.append(...children.filter((child): child is Node | string => child !== null && child !== undefined));
  return made;
}

/** A panel that can be folded; whether it is open is remembered. */
export function panel(title: string, open: boolean, ...children: Child[]): HTMLDetailsElement {
  const key = `panel ${title}`;
  const isOpen = (remembered(key) ?? String(open)) === "true";
  const made = element("details", { open: isOpen, class: "panel" }, element("summary", {}, title), ...children);
  made.addEventListener("toggle", () => remember(key, String(made.open)));
  return made;
}

/** Storage may be forbidden: then nothing is remembered. */
export function remembered(key: string): string | null {
  try {
    return localStorage.getItem(`souple ${key}`);
  } catch {
    return null;
  }
}

export function remember(key: string, value: string): void {
  try {
    localStorage.setItem(`souple ${key}`, value);
  } catch {
    // see above
  }
}
