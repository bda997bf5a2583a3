// Numbers as people read them.

const PREFIXES: [number, string][] = [
  [1e12, "T"],
  [1e9, "G"],
  [1e6, "M"],
  [1e3, "k"],
  [1, ""],
  [1e-3, "m"],
  [1e-6, "µ"],
  [1e-9, "n"],
  [1e-12, "p"],
];

/** Units that take prefixes; kilograms and squares of units do not. */
const PREFIXED = new Set(["Pa", "m", "N", "J", "s", "m/s", "N/m", "J/m³", "W", "Hz"]);

/** `12.3 kPa`; without a unit `0.00123` or `1.2e-7`. */
export function quantity(value: number, unit: string): string {
  if (!Number.isFinite(value)) return `${value} ${unit}`.trim();
  if (value === 0 || !PREFIXED.has(unit)) return `${number(value)} ${unit}`.trim();
  const size = Math.abs(value);
  const [scale, prefix] = PREFIXES.find(([scale]) => size >= 0.9995 * scale) ?? [1, ""];
  return `${number(value / scale)} ${prefix}${unit}`;
}

/** Three digits that count. */
export function number(value: number): string {
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e5)) return value.toExponential(2).replace("e+", "e");
  return String(Number(value.toPrecision(3)));
}

/** `m/s^2` as `m/s²`. */
export function inPrint(unit: string): string {
  return unit.replaceAll("^2", "²").replaceAll("^3", "³");
}

/** `von_mises` as `von Mises`, `youngs_modulus` as `Young's modulus`. */
export function label(name: string): string {
  const words: Record<string, string> = {
    von_mises: "von Mises stress",
    youngs_modulus: "Young's modulus",
    poissons_ratio: "Poisson's ratio",
    rayleigh_mass: "Rayleigh, mass",
    rayleigh_stiffness: "Rayleigh, stiffness",
  };
  return words[name] ?? name.replaceAll("_", " ");
}
