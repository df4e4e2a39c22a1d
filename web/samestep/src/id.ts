// SPDX-License-Identifier: MIT
/** The id of a body: a whole number that every double holds, 0 for none. */
export type BodyId = number;
/** The id of a shape, as that of a body. */
export type ShapeId = number;

const INDICES = 2 ** 20;

/** The id of an index below 65536, and of its generation: odd, 1 for the first object of the index, more for each
 * further one. Worlds whose objects have given ids are the same whatever the order in which they were made. */
export function id(index: number, generation = 1): number {
  if (!Number.isInteger(index) || index < 0 || index >= 65536) {
    throw new RangeError(`An index is from 0 to 65535, not ${index}`);
  }
  if (!Number.isInteger(generation) || generation < 1 || generation > 0xffffffff || generation % 2 === 0) {
    throw new RangeError(`A generation is odd and from 1 to 4294967295, not ${generation}`);
  }
  return generation * INDICES + index;
}
/** The index of an id. */
export const indexOf = (of: number): number => of % INDICES;
/** The generation of an id. */
export const generationOf = (of: number): number => Math.floor(of / INDICES);

/** The halves of the 64 bits of an id, and back. What is no id at all becomes one that names nothing. */
export const low = (of: number): number => (of >= INDICES ? of % INDICES : of === 0 ? 0 : 0xffffffff);
export const high = (of: number): number => (of >= INDICES ? Math.floor(of / INDICES) : of === 0 ? 0 : 0xffffffff);
export function fromHalves(lowHalf: number, highHalf: number): number {
  if (lowHalf >= INDICES) throw new RangeError(`An index of ${lowHalf} is beyond what ids hold here`);
  return highHalf * INDICES + lowHalf;
}
