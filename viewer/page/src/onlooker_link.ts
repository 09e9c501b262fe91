/** A link by which one only looks on: `watch=1` in the query, the token as it is. Pure. */
export function onlookerLink(address: string): string {
  const url = new URL(address);
  url.searchParams.set("watch", "1");
  return url.href;
}

export function isOnlooker(address: string): boolean {
  return new URL(address).searchParams.get("watch") === "1";
}

/** @returns whether it is in the clipboard; a page that came by plain HTTP from another machine has none */
export async function copy(text: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    return false;
  }
}
