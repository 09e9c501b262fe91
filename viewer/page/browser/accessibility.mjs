// What axe-core finds wrong on a page: WCAG 2.2 A and AA and its good practices.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";

const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

/** One line for each element that breaks a rule. */
export async function accessibilityFaults(page) {
  await page.evaluate(axe);
  const violations = await page.evaluate(async () => (await window.axe.run(document, { resultTypes: ["violations"] })).violations);
  return violations.flatMap(({ id, nodes }) => nodes.map(({ target, failureSummary }) => `${id}: ${target.join(" ")}: ${failureSummary}`));
}

/**
 * Contrasts of texts that lie over the picture, which axe-core does not judge: with both ends of the stage's gradient
 * and with what lies between, as far as it has a colour of its own.
 * @returns the least contrast of each text, by its selector
 */
export function contrastsOverPicture(page, selectors) {
  return page.evaluate((selectors) => {
    const flat = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
    const rgba = (colour) => {
      flat.clearRect(0, 0, 1, 1);
      flat.fillStyle = colour;
      flat.fillRect(0, 0, 1, 1);
      return [...flat.getImageData(0, 0, 1, 1).data];
    };
    const over = ([r, g, b, a], ground) => [r, g, b].map((part, i) => (part * a + ground[i] * (255 - a)) / 255);
    const luminance = (parts) => {
      const [r, g, b] = parts.map((part) => (part / 255 <= 0.04045 ? part / 255 / 12.92 : ((part / 255 + 0.055) / 1.055) ** 2.4));
      return 0.2126 * r + 0.7152 * g + 0.0722 * b;
    };
    const root = getComputedStyle(document.documentElement);
    const grounds = ["--ground", "--ground-far"].map((name) => rgba(root.getPropertyValue(name)));
    return selectors.map((selector) => {
      const element = document.querySelector(selector);
      const stack = [];
      for (let up = element; up !== document.querySelector(".stage"); up = up.parentElement) stack.unshift(rgba(getComputedStyle(up).backgroundColor));
      const contrasts = grounds.map((ground) => {
        const behind = stack.reduce((below, layer) => over(layer, below), ground);
        const [light, dark] = [luminance(behind), luminance(over(rgba(getComputedStyle(element).color), behind))].sort((a, b) => b - a);
        return (light + 0.05) / (dark + 0.05);
      });
      return [selector, Math.min(...contrasts)];
    });
  }, selectors);
}
