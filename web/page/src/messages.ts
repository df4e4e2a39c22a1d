// SPDX-License-Identifier: MIT
import type { SessionState } from 'samestep';

/** What the page says to a peer. */
export type ToPeer =
  | { kind: 'begin'; seat: number; crates: number; joins: boolean; module: WebAssembly.Module }
  | { kind: 'datagram'; from: number; bytes: Uint8Array }
  | { kind: 'held'; keys: number }
  | { kind: 'flip' };

/** What a peer says to the page. */
export type FromPeer =
  | { kind: 'datagram'; to: number; bytes: Uint8Array }
  | {
      kind: 'frame';
      /** id, x, y and angle of each body. */
      poses: Float32Array;
      state: SessionState;
      /** Milliseconds that the frame took. */
      took: number;
      memory: number;
    }
  /** Of the world after so many steps, all of whose inputs are known. */
  | { kind: 'hash'; tick: number; hash: string }
  | { kind: 'said'; text: string };
