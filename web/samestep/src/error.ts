// SPDX-License-Identifier: MIT
import { statuses } from './abi.js';

type Name = (typeof statuses)[keyof typeof statuses];
/** Why a call was refused, by the names of the C interface; DISPOSED is what has been given back. */
export type Code = Exclude<Name, 'OK'> | 'DISPOSED';

/** A call that was refused: it changed nothing, and every world goes on. */
export class SamestepError extends Error {
  override readonly name = 'SamestepError';
  constructor(
    /** Why, for programs: 'BODY_NOT_FOUND', 'MALFORMED_BYTES', ... */
    readonly code: Code,
    message: string,
  ) {
    super(message);
  }
}

/** The name of a status. */
export function codeOf(status: number): Code {
  return ((statuses as Record<number, string>)[status] ?? 'INTERNAL') as Code;
}
