// SPDX-License-Identifier: MIT
export { Body, type BodyState } from './body.js';
export { Contact, type ContactHandler, type ContactPoint, type ContactState } from './contact.js';
export type { Vec2 } from './core.js';
export type { BodyDef, BodyType, Filter, Settings, ShapeDef, Surface } from './definitions.js';
export { Engine, type InitOptions } from './engine.js';
export { type Code, SamestepError } from './error.js';
export { type BodyId, generationOf, id, indexOf, type ShapeId } from './id.js';
export { Joint, type JointDef, type JointId, type JointKind } from './joint.js';
export {
  type Command, type PlayedCommand, Player, type PlayerState, Recorder, type Verdict, type VerifyOptions, type Wiring,
} from './recording.js';
export {
  dataChannelTransport, type Frame, type OwnState, type PlayerInput, Session, type SessionDef, type SessionEvent,
  type SessionState, type Transport,
} from './session.js';
export { Shape, type ShapeState } from './shape.js';
export {
  type ContactEvent, type Events, type ImpactEvent, type Limits, type Poses, type Scalar, Slot, World, type WorldDef,
} from './world.js';
