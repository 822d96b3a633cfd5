// Texts of the page in the reader's language, by their English texts in the scripts.

let known = {};

/** Take translations by their English texts; none: the page is in English. */
export function speak(translations) {
  known = translations ?? {};
}

/** A text as the reader has it, with values in its places: {} in the English, {0} and so on in a translation. */
export function said(english, ...values) {
  let next = 0;
  return (known[english] ?? english).replace(/\{(\d*)\}/g, (_, place) => values[place === "" ? next++ : Number(place)]);
}

/** A number with so many decimals, as the reader writes it. */
export const decimal = (value, digits) => asWritten(value.toFixed(digits));

/** The decimal sign is the one of one half. */
export const asWritten = (number) => String(number).replace(".", said("0.5")[1]);
