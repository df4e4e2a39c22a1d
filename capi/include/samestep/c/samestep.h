/* SPDX-License-Identifier: MIT */
#ifndef SAMESTEP_C_SAMESTEP_H
#define SAMESTEP_C_SAMESTEP_H

/* The C interface of Samestep, a deterministic 2D physics engine: docs/c.md is its manual.
 *
 * Each function that can be refused returns a status, SAMESTEP_OK or why not, and gives its results through
 * its last arguments. A call that is refused changes neither the world nor what its result pointers point at,
 * and leaves a sentence that samestep_last_message tells. No exception leaves a function, and none may leave
 * a function of the caller's.
 *
 * Units are metres, kilograms, seconds and radians; angles turn counter-clockwise. Numbers are double at this
 * border, whatever the world computes with. A Fixed world (Q32.32) takes the value nearest to a double. All
 * that it gives back fits a double exactly but angles, forces, torques, moments and energies above 2^21;
 * samestep_body_get_raw tells those to the last bit. NaN and infinities are refused.
 *
 * Ids are 64 bits: an index in the low half, a generation in the high half; 0 names nothing. An id of an
 * object that is gone never names another one. What is listed comes in the order of indices.
 *
 * A world, and what belongs to it, is used by one thread at a time; different worlds by different threads. A
 * pointer to an array that a function gives lives until the next call of the same function for that world,
 * until the next step or change of the world, or until its end, whichever comes first.
 */

#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32) && defined(SAMESTEP_C_SHARED)
#ifdef SAMESTEP_C_BUILDING
#define SAMESTEP_C_API __declspec(dllexport)
#else
#define SAMESTEP_C_API __declspec(dllimport)
#endif
#elif defined(__GNUC__)
#define SAMESTEP_C_API __attribute__((visibility("default")))
#else
#define SAMESTEP_C_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Versions ---- */

/* The version of this interface: what the field `version` of a structure holds. It rises when a structure or
 * the meaning of a function changes. */
enum { SAMESTEP_C_VERSION = 1 };

/* The version of this interface that the library was built with. A program that loads the library at run time
 * compares it with SAMESTEP_C_VERSION before it calls anything else. */
SAMESTEP_C_API uint32_t samestep_c_version(void);
/* The version of the library, "major.minor.patch". */
SAMESTEP_C_API const char* samestep_version(void);
/* The revision of the simulation, which changes whenever any result of a step changes. */
SAMESTEP_C_API uint32_t samestep_simulation_revision(void);

/* ---- Status ---- */

/* SAMESTEP_OK or why a call was refused. */
typedef int32_t samestep_status;

enum {
  SAMESTEP_OK = 0, /* The call has been made. */
  /* Of this interface. */
  SAMESTEP_NULL_ARGUMENT = 1,    /* A pointer that must point at something is null. */
  SAMESTEP_WRONG_VERSION = 2,    /* The field `version` of a structure is not SAMESTEP_C_VERSION. */
  SAMESTEP_BUFFER_TOO_SMALL = 3, /* The size that is needed has been told; nothing else has happened. */
  SAMESTEP_OUT_OF_MEMORY = 4,    /* The system gave no memory. */
  SAMESTEP_WRONG_SCALAR = 5,     /* Two objects that must compute with the same scalar do not. */
  SAMESTEP_SCALAR_NOT_BUILT = 6, /* This build of the library lacks the scalar. */
  SAMESTEP_OTHER_REVISION = 7,   /* Bytes of another revision of the simulation. */
  SAMESTEP_IN_USE = 8, /* A world that a recorder or session still uses, or not the caller's to destroy. */
  SAMESTEP_UNKNOWN_VALUE = 9, /* A number that names no kind, type, solver, phase or the like. */
  SAMESTEP_INTERNAL = 10,     /* What should not happen; the message tells more. */
  /* Faults of the engine; those that no call of this interface meets are listed as well. */
  SAMESTEP_ATTACHED_BODY = 100,               /* A body that is in another world. */
  SAMESTEP_ATTACHED_SHAPE = 101,              /* A shape that is in another world. */
  SAMESTEP_ATTACHED_STATIC_BODY = 102,        /* The static body has shapes and cannot be replaced. */
  SAMESTEP_ATTACHED_STATIC_INDEX = 103,       /* Internal: an index of static shapes. */
  SAMESTEP_BODY_NOT_FOUND = 104,              /* The id names no body of this world, or none any more. */
  SAMESTEP_BUFFER_OVERFLOW = 105,             /* Internal: a buffer of contacts. */
  SAMESTEP_COLLISION_CONTACT_OVERFLOW = 106,  /* Internal: points of a contact. */
  SAMESTEP_COLLISION_ERROR = 107,             /* Internal: the order of two shapes. */
  SAMESTEP_CONTACT_INDEX_OUT_OF_BOUNDS = 108, /* A point that a contact does not have. */
  SAMESTEP_DUPLICATE_BODY = 109,              /* A body that is in the world. */
  SAMESTEP_DUPLICATE_SHAPE = 110,             /* A shape that is in the world. */
  SAMESTEP_ILLEGAL_BODY = 111, /* A value of a body outside its range, or a body that cannot be stepped. */
  SAMESTEP_ILLEGAL_SIZE = 112, /* Internal: the size of a table. */
  SAMESTEP_IMMUTABLE_NUM_CONTACTS = 113,   /* Another number of points than the contact has. */
  SAMESTEP_INDEX_OUT_OF_BOUNDS = 114,      /* An index beyond the end, or above what ids may have. */
  SAMESTEP_INFINITE_MASS = 115,            /* A mass that is infinite. */
  SAMESTEP_INSUFFICIENT_BUFFER_SIZE = 116, /* Internal: a buffer. */
  SAMESTEP_INVALID_CHILD = 117,            /* Internal: a node of a tree. */
  SAMESTEP_INVALID_ITER = 118,             /* Iterations outside [1, 1000], or substeps outside [1, 100]. */
  SAMESTEP_LEAF_ERROR = 119,               /* Internal: a leaf of a tree. */
  SAMESTEP_MAIN_STATIC_BODY = 120,    /* The static body of the world can be neither removed nor retyped. */
  SAMESTEP_NAN_MASS = 121,            /* A mass that is NaN. */
  SAMESTEP_NAN_MOMENT = 122,          /* A moment that is NaN. */
  SAMESTEP_NEGATIVE_ELASTICITY = 123, /* An elasticity below 0. */
  SAMESTEP_NEGATIVE_FRICTION = 124,   /* A friction below 0. */
  SAMESTEP_NEGATIVE_HALF_DIMENSIONS = 125, /* A box whose sides are negative. */
  SAMESTEP_NEGATIVE_MASS = 126,            /* A mass below 0. */
  SAMESTEP_NEGATIVE_MOMENT = 127,          /* A moment below 0. */
  SAMESTEP_NEGATIVE_RADIUS = 128,          /* A radius below 0. */
  SAMESTEP_NOT_CIRCLE_SHAPE = 129,         /* A shape that is no circle. */
  SAMESTEP_NOT_SEGMENT_SHAPE = 130,        /* A shape that is no segment. */
  SAMESTEP_NOT_POLY_SHAPE = 131,           /* A shape that is no polygon. */
  SAMESTEP_SAME_VERTICES = 132,            /* Internal: vertices in one place. */
  SAMESTEP_SHAPE_NOT_FOUND = 133,          /* The id names no shape of this world, or none any more. */
  SAMESTEP_SPACE_LOCKED = 134,         /* A step or a visit is under way; a post-step function may do it. */
  SAMESTEP_SPACE_LOCK_UNDERFLOW = 135, /* Internal: the lock of a world. */
  SAMESTEP_STATIC_BODY_MASS = 136,     /* Only a dynamic body has a mass and a moment. */
  SAMESTEP_UNSOLVABLE_COLLISION = 137, /* A contact of which nothing moves either body. */
  SAMESTEP_INFINITE_MOMENT = 138,      /* A moment that is infinite; see samestep_body_def. */
  SAMESTEP_MASS_OUT_OF_RANGE = 139,    /* A mass outside 0.001 to 10^6 kg that is not 0. */
  SAMESTEP_MOMENT_OUT_OF_RANGE = 140,  /* A moment outside 2^-20 to 2^30 kg m^2 that is not 0. */
  SAMESTEP_SIZE_OUT_OF_RANGE = 141,    /* A length of a shape outside its range. */
  SAMESTEP_VALUE_OUT_OF_RANGE = 142,   /* Any other number that is not finite or outside its range. */
  SAMESTEP_DEGENERATE_SHAPE = 143,     /* A polygon without area or not convex, a segment that is a point. */
  SAMESTEP_TOO_MANY_VERTICES = 144,    /* A polygon of more than 32 vertices. */
  SAMESTEP_BODY_HAS_SHAPES = 145,      /* A body with shapes. */
  SAMESTEP_MISSING_CALLBACK = 146,     /* A number under which no function is registered. */
  SAMESTEP_FOREIGN_WORLD =
      147, /* A slot in which nothing was saved; a world that a recorder cannot follow. */
  SAMESTEP_MALFORMED_BYTES = 148,    /* Bytes from outside that are not what they should be. */
  SAMESTEP_KERNEL_UNAVAILABLE = 149, /* Instructions that this processor lacks. */
  SAMESTEP_ILLEGAL_ID = 150,         /* An id that its slot cannot have any more. */
  SAMESTEP_UNSOUND_ARITHMETIC = 151, /* The processor is in a mode in which double gives other results. */
  SAMESTEP_TOO_MANY_PAIRS = 152,     /* More shapes near each other than the world may hold as pairs. */
  SAMESTEP_INTERRUPTED = 153,        /* A call that was to end; see samestep_world_set_interrupt. */
  SAMESTEP_LEFT_MIDWAY = 154,     /* A world in which a change ended midway; see samestep_world_is_usable. */
  SAMESTEP_JOINT_NOT_FOUND = 155, /* A joint id that names nothing. */
  SAMESTEP_ILLEGAL_JOINT = 156    /* A joint with a number out of its range, or with two ends on one body. */
};

/* The name of a status as in this header, without SAMESTEP_: "BODY_NOT_FOUND"; "UNKNOWN" for any other
 * number. */
SAMESTEP_C_API const char* samestep_status_name(samestep_status status);
/* A sentence about a status. It lives for ever. */
SAMESTEP_C_API const char* samestep_status_message(samestep_status status);

/* ---- Numbers and ids ---- */

/* What a world computes with. */
enum {
  SAMESTEP_FIXED = 1, /* Q32.32: the same bits on every processor, compiler and option. */
  SAMESTEP_DOUBLE = 2 /* IEEE-754, the same bits with contraction off, as samestep::flags asks for. */
};

/* Whether this build has a scalar: 1 or 0. */
SAMESTEP_C_API int32_t samestep_scalar_built(int32_t scalar);
/* A number that says how this build computes on this machine; peers that differ would not stay in step.
 * SAMESTEP_SCALAR_NOT_BUILT, SAMESTEP_UNKNOWN_VALUE. */
SAMESTEP_C_API samestep_status samestep_fingerprint(int32_t scalar, uint64_t* fingerprint);

typedef uint64_t samestep_body_id;
typedef uint64_t samestep_shape_id;
typedef uint64_t samestep_joint_id;

/* The id of an index and a generation, for objects whose ids the game gives. Generations are odd, 1 for the
 * first object of an index, and rise with each further one. */
SAMESTEP_C_API uint64_t samestep_make_id(uint32_t index, uint32_t generation);

/* A vector, in metres unless something else is said. */
typedef struct samestep_vec2 {
  double x;
  double y;
} samestep_vec2;

/* An axis-aligned box, its edges included, m. */
typedef struct samestep_box {
  double left;
  double bottom;
  double right;
  double top;
} samestep_box;

/* ---- Worlds ---- */

/* Bodies, shapes and their collisions, stepped in equal steps. */
typedef struct samestep_world samestep_world;
/* Two touching shapes, as a collision handler sees them; it lives for the call only. */
typedef struct samestep_contact samestep_contact;
/* A world kept in memory. */
typedef struct samestep_slot samestep_slot;
/* A recording being made. */
typedef struct samestep_recorder samestep_recorder;

enum {
  SAMESTEP_SEQUENTIAL_IMPULSES = 0, /* As Chipmunk: `iterations` passes over all contacts. */
  SAMESTEP_SOFT_STEP = 1            /* `substeps` small steps with soft contacts; more accurate in piles. */
};
enum {
  SAMESTEP_ACCURATE = 0, /* To the unit of the scalar. */
  SAMESTEP_FAST = 1      /* Contacts of the soft step in integers of 32 bits; double: no difference. */
};

/* How a world is simulated. All of it is state: saved and hashed. */
typedef struct samestep_settings {
  uint32_t version;
  int32_t solver;     /* SAMESTEP_SOFT_STEP at first. */
  int32_t precision;  /* SAMESTEP_ACCURATE at first. */
  int32_t iterations; /* Sequential impulses: 1 to 1000; 10 at first. */
  int32_t substeps;   /* Soft step: 1 to 100; 4 at first. */
  uint32_t
      collision_persistence;   /* Steps for which a contact that came apart keeps its impulses; 3 at first. */
  samestep_vec2 gravity;       /* m/s^2, each component within 2^15; 0 at first. */
  double damping;              /* What is left of a velocity after a second, 0 to 1; 1 at first. */
  double collision_slop;       /* Sequential impulses: overlap that is left alone, m, 0 to 2^8. */
  double collision_bias;       /* Sequential impulses: what is left of an overlap after a second, 0 to 1. */
  double contact_hertz;        /* Soft step: greatest stiffness of contacts, 1/s, 0 to 1000; 1000 at first. */
  double contact_damping;      /* Soft step: their damping, 0 to 100, 1 being critical; 10 at first. */
  double contact_push_speed;   /* Soft step: the greatest speed at which overlaps are pushed apart, m/s. */
  double contact_margin;       /* Soft step: shapes this close are solved before they touch, m, 0 to 1. */
  double bounce_threshold;     /* Soft step: slower impacts do not bounce, m/s. */
  double world_extent;         /* Bodies are held within it along each axis, m, above 0, at most 2^20. */
  double sleep_time_threshold; /* Rest after which islands sleep, s, 0 to 2^10; 0 at first: none does. */
  double idle_speed_threshold; /* Bodies that are no faster are at rest, m/s, 0 to 2^10; 0.05 at first. */
  int32_t continuous;          /* 1: bodies that go far in a step are stopped on their way; 0 at first. */
  int32_t reserved;            /* 0 */
} samestep_settings;

/* What a new world is to be. */
typedef struct samestep_world_def {
  uint32_t version;
  int32_t scalar;     /* SAMESTEP_FIXED at first. */
  uint32_t max_pairs; /* How many pairs of shapes near each other it may hold, at most 2^28; 2^18 at first. */
  int32_t workers;    /* Threads that share a step, 1 to 64; 1 at first. No result depends on it. */
  samestep_settings settings;
} samestep_world_def;

/* Sets all fields to their defaults. Null does nothing. */
SAMESTEP_C_API void samestep_settings_init(samestep_settings* settings);
/* Sets all fields, those of the settings too, to their defaults. Null does nothing. */
SAMESTEP_C_API void samestep_world_def_init(samestep_world_def* def);

/* Makes a world with one static body. Refused as the settings are, and with SAMESTEP_WRONG_VERSION,
 * SAMESTEP_SCALAR_NOT_BUILT, SAMESTEP_UNKNOWN_VALUE. */
SAMESTEP_C_API samestep_status samestep_world_create(const samestep_world_def* def, samestep_world** world);
/* Ends a world; null does nothing. SAMESTEP_SPACE_LOCKED from within a step or a function that the world
 * calls; SAMESTEP_IN_USE while a recorder or session uses it, and for a world that a callback of
 * samestep_verify was given. */
SAMESTEP_C_API samestep_status samestep_world_destroy(samestep_world* world);

/* The sentence that tells why the last refused call for this world was refused, or with null the last one of
 * this thread that was for no world; "" if there was none. It lives until the next refused call. */
SAMESTEP_C_API const char* samestep_last_message(const samestep_world* world);

/* SAMESTEP_FIXED or SAMESTEP_DOUBLE. */
SAMESTEP_C_API samestep_status samestep_world_get_scalar(const samestep_world* world, int32_t* scalar);
/* The settings, with the version of this interface. */
SAMESTEP_C_API samestep_status samestep_world_get_settings(const samestep_world* world,
                                                           samestep_settings* settings);
/* Sets all settings or none. SAMESTEP_WRONG_VERSION, SAMESTEP_UNKNOWN_VALUE, SAMESTEP_INVALID_ITER,
 * SAMESTEP_VALUE_OUT_OF_RANGE. */
SAMESTEP_C_API samestep_status samestep_world_set_settings(samestep_world* world,
                                                           const samestep_settings* settings);
/* m/s^2, each component within 2^15. SAMESTEP_VALUE_OUT_OF_RANGE. */
SAMESTEP_C_API samestep_status samestep_world_set_gravity(samestep_world* world, double x, double y);

/* Makes one step of `seconds`, in [0, 1]; 0 does nothing. A double is not always what a Fixed world would
 * call 1/60: games with a fixed rate use samestep_world_step_at. SAMESTEP_SPACE_LOCKED,
 * SAMESTEP_VALUE_OUT_OF_RANGE; SAMESTEP_ILLEGAL_BODY for a dynamic body without mass or moment;
 * SAMESTEP_MISSING_CALLBACK; SAMESTEP_UNSOUND_ARITHMETIC; SAMESTEP_TOO_MANY_PAIRS, when position functions
 * have run but before anything in the world changes. */
SAMESTEP_C_API samestep_status samestep_world_step(samestep_world* world, double seconds);
/* Makes one step of 1/rate seconds, rounded once by the scalar; rate from 1 to 1000000. As
 * samestep_world_step. */
SAMESTEP_C_API samestep_status samestep_world_step_at(samestep_world* world, uint32_t rate);
/* Steps made so far. */
SAMESTEP_C_API samestep_status samestep_world_get_tick(const samestep_world* world, uint64_t* tick);
/* Whether a step, query or visit is under way: 1 or 0. */
SAMESTEP_C_API samestep_status samestep_world_is_locked(const samestep_world* world, int32_t* locked);

/* Whether the world is whole: 1 or 0. A change that ends midway, by an interrupt or for want of memory,
 * leaves it unusable: what reads or changes it answers SAMESTEP_LEFT_MIDWAY until a whole world has been
 * restored or read. */
SAMESTEP_C_API samestep_status samestep_world_is_usable(const samestep_world* world, int32_t* usable);
/* Asked now and then, also on a worker's thread, whether a long call shall end: 1 ends it with
 * SAMESTEP_INTERRUPTED, and leaves a world that was being stepped midway. It calls nothing for the world. */
typedef int32_t (*samestep_interrupt)(void* data);
/* Sets who is asked, or null for nobody. */
SAMESTEP_C_API samestep_status samestep_world_set_interrupt(samestep_world* world,
                                                            samestep_interrupt interrupt, void* data);
/* Work done so far, in units that follow from the calls alone, whoever computes. */
SAMESTEP_C_API samestep_status samestep_world_get_work(const samestep_world* world, uint64_t* work);
/* Calls that go beyond so much work end as if interrupted, in the same place on every machine. Without limit
 * at first. */
SAMESTEP_C_API samestep_status samestep_world_set_max_work(samestep_world* world, uint64_t work);

/* How many bodies there are, the static one included. */
SAMESTEP_C_API samestep_status samestep_world_get_body_count(const samestep_world* world, uint32_t* count);
/* How many shapes there are. */
SAMESTEP_C_API samestep_status samestep_world_get_shape_count(const samestep_world* world, uint32_t* count);

/* How many threads share a step, 1 to 64: the calling one and others, which the world starts and ends.
 * Workers help the soft step, and no result depends on them. SAMESTEP_SPACE_LOCKED,
 * SAMESTEP_VALUE_OUT_OF_RANGE. */
SAMESTEP_C_API samestep_status samestep_world_set_workers(samestep_world* world, int32_t workers);
/* A game's own job system. It calls task(index, task_data) once for each index from 0 to tasks - 1, on any
 * threads and in any order, and returns when all have returned. */
typedef void (*samestep_run_tasks)(void* data, int32_t tasks, void (*task)(int32_t index, void* task_data),
                                   void* task_data);
/* Steps with `workers` threads of a job system; null ends that. As samestep_world_set_workers. */
SAMESTEP_C_API samestep_status samestep_world_set_task_runner(samestep_world* world, int32_t workers,
                                                              samestep_run_tasks run, void* data);
/* How many pairs of shapes near each other the world may hold, at most 2^28: what bounds memory and time of a
 * step. SAMESTEP_SPACE_LOCKED, SAMESTEP_VALUE_OUT_OF_RANGE. */
SAMESTEP_C_API samestep_status samestep_world_set_max_pairs(samestep_world* world, uint32_t pairs);

/* Told what the library points out without refusing it, such as fewer workers than asked for. The text lives
 * for the call only. */
typedef void (*samestep_log)(const char* text, void* data);
/* Sets the function that is told, or null for none. */
SAMESTEP_C_API samestep_status samestep_world_set_log(samestep_world* world, samestep_log log, void* data);
/* Told of each call for this world that is refused, with the sentence, before it returns: a place for a
 * breakpoint. It calls nothing for this world. */
typedef void (*samestep_failure)(samestep_status status, const char* message, void* data);
/* Sets the function that is told, or null for none. */
SAMESTEP_C_API samestep_status samestep_world_set_failure_hook(samestep_world* world,
                                                               samestep_failure failure, void* data);

/* ---- Bodies ---- */

enum {
  SAMESTEP_DYNAMIC = 0,   /* Moved by forces, gravity and contacts. */
  SAMESTEP_KINEMATIC = 1, /* Moved by its own velocity alone; pushes dynamic bodies, is pushed by nothing. */
  SAMESTEP_STATIC = 2     /* Never moves. */
};

/* What a new body is to be. */
typedef struct samestep_body_def {
  uint32_t version;
  int32_t type;    /* SAMESTEP_DYNAMIC at first. */
  int32_t rotates; /* 0 for a dynamic body that no impulse turns; 1 at first. */
  int32_t bullet;  /* 1: also stopped by what contacts move, where it goes far in a step; 0 at first. */
  /* 0: the world gives one. Worlds whose ids are all given are the same bit by bit whatever the order in
   * which objects came and went; see samestep_make_id. The index is below 2^16. */
  samestep_body_id id;
  uint64_t user_data;
  samestep_vec2 position;  /* Of the body's origin, m, within the world's extent. */
  double angle;            /* rad, within 2^30. */
  samestep_vec2 velocity;  /* Of the centre of mass, m/s, each component within 2^10; 0 for a static body. */
  double angular_velocity; /* rad/s, within 2^8. */
  double mass;             /* kg, 0.001 to 10^6; 0: of its shapes. */
  double moment; /* kg m^2 about the centre of mass, 2^-20 to 2^30; 0: of its shapes, or does not rotate. */
  uint32_t position_function; /* Numbers of registered functions; 0: the engine's own. */
  uint32_t velocity_function;
} samestep_body_def;

/* Where a body is and how it moves. */
typedef struct samestep_body_state {
  samestep_body_id id;
  uint64_t user_data;
  samestep_vec2 position; /* Of the origin, m. */
  samestep_vec2 rotation; /* Cosine and sine of the angle. */
  double angle;
  samestep_vec2 center_of_mass; /* In the coordinates of the body, m. */
  samestep_vec2 world_center;   /* The same place in the world, m. */
  samestep_vec2 velocity;       /* Of the centre of mass, m/s. */
  double angular_velocity;
  samestep_vec2 force;   /* Acts in the next step, which clears it, N. */
  double torque;         /* N m */
  double mass;           /* kg; 0 of a body that is not dynamic. */
  double moment;         /* kg m^2 about the centre of mass; 0 of a body that is not dynamic. */
  double kinetic_energy; /* J */
  int32_t type;
  int32_t rotates;
  uint32_t position_function;
  uint32_t velocity_function;
  int32_t sleeps;         /* 1 while steps leave it alone. */
  int32_t may_sleep;      /* 0 of a body that keeps its island awake. */
  int32_t bullet;         /* 1: stopped by what contacts move, too, where it goes far in a step. */
  int32_t reserved;       /* 0 */
  double gravity_scale;   /* Factor of gravity in its acceleration. */
  double linear_damping;  /* 1/s */
  double angular_damping; /* 1/s */
  double speed_limit;     /* m/s, 2^10 for none. */
  double spin_limit;      /* rad/s, 2^8 for none. */
} samestep_body_state;

/* What drawing needs of a body. */
typedef struct samestep_pose {
  samestep_body_id id;
  samestep_vec2 position;
  samestep_vec2 rotation; /* Cosine and sine of the angle. */
} samestep_pose;

/* Sets all fields to their defaults: a dynamic body at rest at the origin. Null does nothing. */
SAMESTEP_C_API void samestep_body_def_init(samestep_body_def* def);
/* Adds a body. SAMESTEP_WRONG_VERSION, SAMESTEP_UNKNOWN_VALUE, then what the fields are refused with:
 * SAMESTEP_NAN_MASS and the like, SAMESTEP_ILLEGAL_BODY; SAMESTEP_SPACE_LOCKED; of a given id
 * SAMESTEP_INDEX_OUT_OF_BOUNDS, SAMESTEP_ILLEGAL_ID. */
SAMESTEP_C_API samestep_status samestep_body_create(samestep_world* world, const samestep_body_def* def,
                                                    samestep_body_id* body);
/* Removes a body with its shapes. SAMESTEP_BODY_NOT_FOUND, SAMESTEP_MAIN_STATIC_BODY, SAMESTEP_SPACE_LOCKED.
 */
SAMESTEP_C_API samestep_status samestep_body_destroy(samestep_world* world, samestep_body_id body);
/* The body for what never moves, always there. */
SAMESTEP_C_API samestep_status samestep_world_get_static_body(const samestep_world* world,
                                                              samestep_body_id* body);
/* Whether the id names a body of this world: 1 or 0. */
SAMESTEP_C_API samestep_status samestep_body_exists(const samestep_world* world, samestep_body_id body,
                                                    int32_t* exists);
/* The poses of all bodies, by id. */
SAMESTEP_C_API samestep_status samestep_world_get_poses(samestep_world* world, const samestep_pose** poses,
                                                        size_t* count);

/* All functions on a body answer SAMESTEP_BODY_NOT_FOUND for an id that names none. Setters answer
 * SAMESTEP_ILLEGAL_BODY for a value outside the range that samestep_body_def tells, and
 * SAMESTEP_VALUE_OUT_OF_RANGE for NaN and infinities. */

/* All of a body at once. */
SAMESTEP_C_API samestep_status samestep_body_get(const samestep_world* world, samestep_body_id body,
                                                 samestep_body_state* state);
/* Moves the body's origin, and forgets what pushed the body out of an overlap. */
SAMESTEP_C_API samestep_status samestep_body_set_position(samestep_world* world, samestep_body_id body,
                                                          double x, double y);
/* Turns the body about its origin. */
SAMESTEP_C_API samestep_status samestep_body_set_angle(samestep_world* world, samestep_body_id body,
                                                       double angle);
/* The velocity of the centre of mass, m/s. SAMESTEP_ILLEGAL_BODY also for a moving static body. */
SAMESTEP_C_API samestep_status samestep_body_set_velocity(samestep_world* world, samestep_body_id body,
                                                          double x, double y);
/* rad/s, counter-clockwise. SAMESTEP_ILLEGAL_BODY also for a turning static body. */
SAMESTEP_C_API samestep_status samestep_body_set_angular_velocity(samestep_world* world,
                                                                  samestep_body_id body,
                                                                  double angular_velocity);
/* The force on the centre of mass in the next step, N, each component within 2^30. */
SAMESTEP_C_API samestep_status samestep_body_set_force(samestep_world* world, samestep_body_id body, double x,
                                                       double y);
/* The torque in the next step, N m, within 2^30. */
SAMESTEP_C_API samestep_status samestep_body_set_torque(samestep_world* world, samestep_body_id body,
                                                        double torque);
/* kg. SAMESTEP_STATIC_BODY_MASS, SAMESTEP_NAN_MASS, SAMESTEP_NEGATIVE_MASS, SAMESTEP_INFINITE_MASS,
 * SAMESTEP_MASS_OUT_OF_RANGE. */
SAMESTEP_C_API samestep_status samestep_body_set_mass(samestep_world* world, samestep_body_id body,
                                                      double mass);
/* kg m^2; a body that did not rotate does so from now on. As samestep_body_set_mass, of moments. */
SAMESTEP_C_API samestep_status samestep_body_set_moment(samestep_world* world, samestep_body_id body,
                                                        double moment);
/* In the coordinates of the body, m, within 2^8. Each point of the body keeps its velocity. */
SAMESTEP_C_API samestep_status samestep_body_set_center_of_mass(samestep_world* world, samestep_body_id body,
                                                                double x, double y);
/* Sets mass, moment and centre of mass to those of the shapes with mass. */
SAMESTEP_C_API samestep_status samestep_body_set_mass_from_shapes(samestep_world* world,
                                                                  samestep_body_id body);
/* SAMESTEP_UNKNOWN_VALUE, SAMESTEP_SPACE_LOCKED, SAMESTEP_MAIN_STATIC_BODY, SAMESTEP_SIZE_OUT_OF_RANGE. */
SAMESTEP_C_API samestep_status samestep_body_set_type(samestep_world* world, samestep_body_id body,
                                                      int32_t type);
/* Any 64 bits; state, saved and hashed: an index or id of the game's, never an address. */
SAMESTEP_C_API samestep_status samestep_body_set_user_data(samestep_world* world, samestep_body_id body,
                                                           uint64_t user_data);
/* Wakes a body, with its island as the next step begins. So does each other function that changes anything.
 */
SAMESTEP_C_API samestep_status samestep_body_activate(samestep_world* world, samestep_body_id body);
/* Spares a dynamic body the wait: it sleeps as soon as its island is at rest. */
SAMESTEP_C_API samestep_status samestep_body_sleep(samestep_world* world, samestep_body_id body);
/* Whether the body may ever sleep, and with it what touches it: 1 at first. */
SAMESTEP_C_API samestep_status samestep_body_set_may_sleep(samestep_world* world, samestep_body_id body,
                                                           int32_t may_sleep);
/* Factor of gravity in its acceleration, within 2^10; 1 at first. SAMESTEP_ILLEGAL_BODY. */
SAMESTEP_C_API samestep_status samestep_body_set_gravity_scale(samestep_world* world, samestep_body_id body,
                                                               double scale);
/* A step of dt seconds divides its velocities by 1 + damping dt, 1/s, 0 to 2^10; 0 at first.
 * SAMESTEP_ILLEGAL_BODY. */
SAMESTEP_C_API samestep_status samestep_body_set_damping(samestep_world* world, samestep_body_id body,
                                                         double linear, double angular);
/* Speed, m/s, 0 to 2^10, and spin, rad/s, 0 to 2^8, beyond which no step leaves it; the largest are none, as
 * at first. SAMESTEP_ILLEGAL_BODY. */
SAMESTEP_C_API samestep_status samestep_body_set_limits(samestep_world* world, samestep_body_id body,
                                                        double speed, double spin);
/* Whether impulses and torques turn the body: 1 or 0. */
SAMESTEP_C_API samestep_status samestep_body_set_rotates(samestep_world* world, samestep_body_id body,
                                                         int32_t rotates);
/* 1: where it goes far in a step the body is stopped by what contacts move, too; 0: only by the rest. */
SAMESTEP_C_API samestep_status samestep_body_set_bullet(samestep_world* world, samestep_body_id body,
                                                        int32_t bullet);
/* The numbers of the functions that move the body and change its velocity; 0: the engine's own. */
SAMESTEP_C_API samestep_status samestep_body_set_functions(samestep_world* world, samestep_body_id body,
                                                           uint32_t position_function,
                                                           uint32_t velocity_function);
/* An impulse in N s at a point of the world changes the velocities at once. */
SAMESTEP_C_API samestep_status samestep_body_apply_impulse(samestep_world* world, samestep_body_id body,
                                                           double impulse_x, double impulse_y, double point_x,
                                                           double point_y);
/* A force in N at a point of the world is added to force and torque. */
SAMESTEP_C_API samestep_status samestep_body_apply_force(samestep_world* world, samestep_body_id body,
                                                         double force_x, double force_y, double point_x,
                                                         double point_y);
/* The velocity of the body's material at a point of the world, m/s. */
SAMESTEP_C_API samestep_status samestep_body_get_velocity_at(const samestep_world* world,
                                                             samestep_body_id body, double x, double y,
                                                             samestep_vec2* velocity);
/* From the coordinates of the body to those of the world, and back. SAMESTEP_VALUE_OUT_OF_RANGE beyond 2^20.
 */
SAMESTEP_C_API samestep_status samestep_body_to_world(const samestep_world* world, samestep_body_id body,
                                                      double x, double y, samestep_vec2* point);
/* From the coordinates of the world to those of the body. SAMESTEP_VALUE_OUT_OF_RANGE beyond 2^20. */
SAMESTEP_C_API samestep_status samestep_body_to_local(const samestep_world* world, samestep_body_id body,
                                                      double x, double y, samestep_vec2* point);
/* The ids of its shapes, rising. */
SAMESTEP_C_API samestep_status samestep_body_get_shapes(samestep_world* world, samestep_body_id body,
                                                        const samestep_shape_id** shapes, size_t* count);

/* What samestep_body_get_raw reads. */
enum {
  SAMESTEP_RAW_POSITION = 0, /* Two numbers, x and y. */
  SAMESTEP_RAW_ANGLE = 1,
  SAMESTEP_RAW_ROTATION = 2, /* Two numbers; follows from the angle. */
  SAMESTEP_RAW_VELOCITY = 3, /* Two numbers. */
  SAMESTEP_RAW_ANGULAR_VELOCITY = 4,
  SAMESTEP_RAW_FORCE = 5, /* Two numbers. */
  SAMESTEP_RAW_TORQUE = 6,
  SAMESTEP_RAW_MASS = 7,
  SAMESTEP_RAW_MOMENT = 8,
  SAMESTEP_RAW_CENTER_OF_MASS = 9, /* Two numbers. */
  SAMESTEP_RAW_WORLD_CENTER = 10   /* Two numbers; follows from the others. */
};
/* The bits of a quantity as the world holds it: of a Fixed world its value in units of 2^-32, of a double
 * world the bits of the double. raw[1] is 0 where there is one number. SAMESTEP_UNKNOWN_VALUE. */
SAMESTEP_C_API samestep_status samestep_body_get_raw(const samestep_world* world, samestep_body_id body,
                                                     int32_t quantity, int64_t raw[2]);
/* Sets a quantity to these bits, as the setter of its name does. SAMESTEP_UNKNOWN_VALUE for what follows from
 * others. */
SAMESTEP_C_API samestep_status samestep_body_set_raw(samestep_world* world, samestep_body_id body,
                                                     int32_t quantity, const int64_t raw[2]);
/* The bits that the world computes with for a double, and back. SAMESTEP_VALUE_OUT_OF_RANGE for NaN,
 * infinities and, in a Fixed world, from 2^31 on. */
SAMESTEP_C_API samestep_status samestep_number_to_raw(const samestep_world* world, double number,
                                                      int64_t* raw);
/* The double nearest to what the bits are to the world. */
SAMESTEP_C_API samestep_status samestep_number_from_raw(const samestep_world* world, int64_t raw,
                                                        double* number);

/* ---- Shapes ---- */

enum {
  SAMESTEP_CIRCLE = 0,        /* `radius` around `a`. */
  SAMESTEP_SEGMENT = 1,       /* From `a` to `b`, grown by `radius`. */
  SAMESTEP_POLYGON = 2,       /* The convex hull of `vertices`, grown by `radius`. */
  SAMESTEP_EXACT_POLYGON = 3, /* Exactly these convex, counter-clockwise `vertices`, grown by `radius`. */
  SAMESTEP_BOX = 4            /* `width` by `height` around the body's origin, grown by `radius`. */
};
/* The most vertices that a polygon may have. */
enum { SAMESTEP_MAX_VERTICES = 32 };

/* What a new shape is to be: geometry in the coordinates of its body, surface, mass and filter. Fields that
 * its kind does not name mean nothing. */
typedef struct samestep_shape_def {
  uint32_t version;
  int32_t kind;         /* SAMESTEP_BOX at first. */
  samestep_shape_id id; /* 0: the world gives one; see samestep_body_def. */
  uint64_t user_data;
  samestep_vec2 a; /* m */
  samestep_vec2 b; /* m */
  double radius;   /* m, at least 0; 0 at first. */
  double width;    /* m, above 0; 1 at first. */
  double height;   /* m, above 0; 1 at first. */
  samestep_vec2
      previous;       /* Segment: where the line goes on before `a` and after `b`; `a` and `b`: nowhere. */
  samestep_vec2 next; /* They count where has_neighbors is 1. */
  const samestep_vec2* vertices; /* 3 to 32 of an exact polygon, any number to take the hull of. */
  uint32_t vertex_count;
  int32_t has_neighbors; /* 0 at first. */
  double mass;           /* kg, 0.001 to 10^6; 0 adds nothing to the body. */
  double density;        /* kg/m^2; where not 0, in place of the mass. */
  double friction;       /* Coulomb's coefficient, 0 to 2^10; that of a contact is the product of two. */
  double elasticity;     /* 0: no bounce, to 2^10; that of a contact is the product of two. */
  samestep_vec2 surface_velocity; /* m/s; only friction feels it. */
  uint32_t collision_type;        /* What handlers are chosen by; 0 at first. */
  uint32_t group;                 /* Shapes of the same group other than 0 do not touch. */
  uint32_t category; /* Shapes touch if the category of each has a bit of the mask of the other: */
  uint32_t mask;     /* all bits at first. */
  int32_t sensor;    /* 1 for a shape that reports contacts and pushes nothing. */
  uint32_t material; /* A number of the game's own; 0 at first. */
} samestep_shape_def;

/* What a shape is. */
typedef struct samestep_shape_state {
  samestep_shape_id id;
  samestep_body_id body;
  uint64_t user_data;
  int32_t kind; /* SAMESTEP_CIRCLE, SAMESTEP_SEGMENT or SAMESTEP_POLYGON. */
  int32_t sensor;
  double radius;
  double mass;
  double density;
  double area;                  /* m^2, the rounding included. */
  samestep_vec2 center_of_mass; /* In the coordinates of its body, m. */
  double friction;
  double elasticity;
  samestep_vec2 surface_velocity;
  uint32_t collision_type;
  uint32_t group;
  uint32_t category;
  uint32_t mask;
  uint32_t material;
  uint32_t reserved; /* 0 */
  double rolling_resistance;
} samestep_shape_state;

/* Sets all fields to their defaults: a box of 1 m without mass or friction that touches everything. Null does
 * nothing. */
SAMESTEP_C_API void samestep_shape_def_init(samestep_shape_def* def);
/* Adds a shape to a body; mass, moment and centre of mass of the body become those of its shapes with mass.
 * SAMESTEP_BODY_NOT_FOUND, SAMESTEP_WRONG_VERSION, SAMESTEP_UNKNOWN_VALUE, SAMESTEP_NULL_ARGUMENT for
 * vertices, then what the fields are refused with; SAMESTEP_SPACE_LOCKED; of a given id
 * SAMESTEP_INDEX_OUT_OF_BOUNDS, SAMESTEP_ILLEGAL_ID. */
SAMESTEP_C_API samestep_status samestep_shape_create(samestep_world* world, samestep_body_id body,
                                                     const samestep_shape_def* def, samestep_shape_id* shape);
/* Removes a shape; separate is called for what it touches. SAMESTEP_SHAPE_NOT_FOUND, SAMESTEP_SPACE_LOCKED.
 */
SAMESTEP_C_API samestep_status samestep_shape_destroy(samestep_world* world, samestep_shape_id shape);
/* Whether the id names a shape of this world: 1 or 0. */
SAMESTEP_C_API samestep_status samestep_shape_exists(const samestep_world* world, samestep_shape_id shape,
                                                     int32_t* exists);
/* Makes a shape what the definition says; it keeps its id and body, and the definition's id means nothing. As
 * samestep_shape_create. */
SAMESTEP_C_API samestep_status samestep_shape_replace(samestep_world* world, samestep_shape_id shape,
                                                      const samestep_shape_def* def);

/* All functions on a shape answer SAMESTEP_SHAPE_NOT_FOUND for an id that names none. */

/* All of a shape but its vertices. */
SAMESTEP_C_API samestep_status samestep_shape_get(const samestep_world* world, samestep_shape_id shape,
                                                  samestep_shape_state* state);
/* Its vertices in the coordinates of its body: of a circle the centre, of a segment its ends, of a polygon
 * the corners, counter-clockwise. */
SAMESTEP_C_API samestep_status samestep_shape_get_vertices(samestep_world* world, samestep_shape_id shape,
                                                           const samestep_vec2** vertices, size_t* count);
/* The smallest box around it where its body is now. */
SAMESTEP_C_API samestep_status samestep_shape_get_bounding_box(samestep_world* world, samestep_shape_id shape,
                                                               samestep_box* box);
/* kg. SAMESTEP_SPACE_LOCKED, SAMESTEP_NAN_MASS, SAMESTEP_NEGATIVE_MASS, SAMESTEP_INFINITE_MASS,
 * SAMESTEP_MASS_OUT_OF_RANGE. */
SAMESTEP_C_API samestep_status samestep_shape_set_mass(samestep_world* world, samestep_shape_id shape,
                                                       double mass);
/* kg/m^2. SAMESTEP_SPACE_LOCKED, SAMESTEP_VALUE_OUT_OF_RANGE, SAMESTEP_NEGATIVE_MASS,
 * SAMESTEP_MASS_OUT_OF_RANGE. */
SAMESTEP_C_API samestep_status samestep_shape_set_density(samestep_world* world, samestep_shape_id shape,
                                                          double density);
/* SAMESTEP_VALUE_OUT_OF_RANGE, SAMESTEP_NEGATIVE_FRICTION. */
SAMESTEP_C_API samestep_status samestep_shape_set_friction(samestep_world* world, samestep_shape_id shape,
                                                           double friction);
/* SAMESTEP_VALUE_OUT_OF_RANGE, SAMESTEP_NEGATIVE_ELASTICITY. */
SAMESTEP_C_API samestep_status samestep_shape_set_elasticity(samestep_world* world, samestep_shape_id shape,
                                                             double elasticity);
/* m/s, each component within 2^10. SAMESTEP_VALUE_OUT_OF_RANGE. */
SAMESTEP_C_API samestep_status samestep_shape_set_surface_velocity(samestep_world* world,
                                                                   samestep_shape_id shape, double x,
                                                                   double y);
/* Which shapes it may touch; see samestep_shape_def. */
SAMESTEP_C_API samestep_status samestep_shape_set_filter(samestep_world* world, samestep_shape_id shape,
                                                         uint32_t group, uint32_t category, uint32_t mask);
/* What handlers are chosen by. */
SAMESTEP_C_API samestep_status samestep_shape_set_collision_type(samestep_world* world,
                                                                 samestep_shape_id shape, uint32_t type);
/* A part of the radius, 0 to 2^10, 0 at first: a contact opposes that its bodies turn against each other.
 * SAMESTEP_VALUE_OUT_OF_RANGE. */
SAMESTEP_C_API samestep_status samestep_shape_set_rolling_resistance(samestep_world* world,
                                                                     samestep_shape_id shape,
                                                                     double resistance);
/* A number of the game's own for what the surface is of; state, saved and hashed. */
SAMESTEP_C_API samestep_status samestep_shape_set_material(samestep_world* world, samestep_shape_id shape,
                                                           uint32_t material);
/* 1 for a shape that reports contacts and pushes nothing, else 0. */
SAMESTEP_C_API samestep_status samestep_shape_set_sensor(samestep_world* world, samestep_shape_id shape,
                                                         int32_t sensor);
/* Any 64 bits; state, saved and hashed, as those of a body. */
SAMESTEP_C_API samestep_status samestep_shape_set_user_data(samestep_world* world, samestep_shape_id shape,
                                                            uint64_t user_data);

/* ---- Joints ---- */

enum {
  SAMESTEP_REVOLUTE = 0,  /* A point of A on a point of B, which turn about it: a hinge. */
  SAMESTEP_PRISMATIC = 1, /* B slides along an axis of A and does not turn against it. */
  SAMESTEP_DISTANCE = 2,  /* How far a point of B is from a point of A: a rod, a rope, a spring. */
  SAMESTEP_WELD = 3,      /* B does not move against A: stiff, or as two springs. */
  SAMESTEP_WHEEL = 4,     /* A point of B slides along an axis of A, and B turns: a suspension, a groove. */
  SAMESTEP_TARGET = 5,    /* Pulls a point of B to a point of A with a greatest force: a mouse, friction. */
  SAMESTEP_GEAR = 6,   /* How far B is turned against A, times a ratio: a gear, a rotary spring or motor. */
  SAMESTEP_RATCHET = 7 /* B turns against A in one direction only. */
};

/* What a joint is to be; docs/joints.md says which fields count for which kind. Points and the axis are in
 * the coordinates of the body they are on. */
typedef struct samestep_joint_def {
  uint32_t version;
  int32_t kind;         /* SAMESTEP_REVOLUTE at first. */
  samestep_joint_id id; /* 0: the world gives one; see samestep_body_def. */
  samestep_body_id body_a;
  samestep_body_id body_b;
  uint64_t user_data;
  samestep_vec2 anchor_a; /* m, each within 2^10. */
  samestep_vec2 anchor_b;
  samestep_vec2 axis;     /* Of A, a unit vector; (1, 0) at first. */
  samestep_vec2 velocity; /* Of a target without a spring, m/s. */
  double rest;            /* Where the spring rests; of a rod its length, of a ratchet its teeth. */
  double angle;           /* B's angle against A's at which the joint's is 0, rad. */
  double lower;           /* Limits, which count where limited is 1: m or rad, of any width. */
  double upper;
  double motor_speed;   /* m/s or rad/s; counts where motor is 1. */
  double motor_max;     /* The greatest force or torque of the motor, N or N m. */
  double hertz;         /* Of the spring, 0 to 1000. */
  double damping;       /* Its damping ratio, 0 to 100; 1 at first. */
  double angular_hertz; /* The same of the angle of a weld or target. */
  double angular_damping;
  double max_force;    /* With which it holds, N; 0: any, of a target none. */
  double max_torque;   /* N m */
  double break_force;  /* Above which it breaks, N; 0: never. */
  double break_torque; /* N m */
  double ratio;        /* Of a gear, 2^-8 to 2^8 in size; 1 at first. */
  int32_t limited;     /* 1 or 0. */
  int32_t motor;
  int32_t spring;
  int32_t collide_connected; /* Whether the bodies' shapes collide with each other; 0 at first. */
} samestep_joint_def;

/* What a joint did in the last step. */
typedef struct samestep_joint_state {
  samestep_vec2 force; /* On B, as a mean of the step, N; 0 after a restore until the next step. */
  double torque;       /* N m */
} samestep_joint_state;

/* Sets all fields to their defaults. Null does nothing. */
SAMESTEP_C_API void samestep_joint_def_init(samestep_joint_def* def);
/* Adds a joint between two bodies. SAMESTEP_BODY_NOT_FOUND, SAMESTEP_WRONG_VERSION, SAMESTEP_UNKNOWN_VALUE,
 * SAMESTEP_VALUE_OUT_OF_RANGE for a number that is not finite, SAMESTEP_ILLEGAL_JOINT, SAMESTEP_SPACE_LOCKED;
 * of a given id SAMESTEP_INDEX_OUT_OF_BOUNDS, SAMESTEP_ILLEGAL_ID. */
SAMESTEP_C_API samestep_status samestep_joint_create(samestep_world* world, const samestep_joint_def* def,
                                                     samestep_joint_id* joint);
/* Removes a joint; those of a body go with it. SAMESTEP_JOINT_NOT_FOUND, SAMESTEP_SPACE_LOCKED. */
SAMESTEP_C_API samestep_status samestep_joint_destroy(samestep_world* world, samestep_joint_id joint);
/* Whether the id names a joint of this world: 1 or 0. */
SAMESTEP_C_API samestep_status samestep_joint_exists(const samestep_world* world, samestep_joint_id joint,
                                                     int32_t* exists);
/* Makes a joint what the definition says; it keeps its id, and the definition's means nothing.
 * SAMESTEP_JOINT_NOT_FOUND, and as samestep_joint_create. */
SAMESTEP_C_API samestep_status samestep_joint_replace(samestep_world* world, samestep_joint_id joint,
                                                      const samestep_joint_def* def);
/* What it is, as a definition. SAMESTEP_JOINT_NOT_FOUND. */
SAMESTEP_C_API samestep_status samestep_joint_get(const samestep_world* world, samestep_joint_id joint,
                                                  samestep_joint_def* def);
/* SAMESTEP_JOINT_NOT_FOUND. */
SAMESTEP_C_API samestep_status samestep_joint_get_state(const samestep_world* world, samestep_joint_id joint,
                                                        samestep_joint_state* state);
/* Number of joints. */
SAMESTEP_C_API samestep_status samestep_world_get_joint_count(const samestep_world* world, uint32_t* count);
/* The joints of a body, by rising id. SAMESTEP_BODY_NOT_FOUND. */
SAMESTEP_C_API samestep_status samestep_body_get_joints(samestep_world* world, samestep_body_id body,
                                                        const samestep_joint_id** joints, size_t* count);
/* The bodies that joints connect with a body, directly or through others that move, by rising id.
 * SAMESTEP_BODY_NOT_FOUND. */
SAMESTEP_C_API samestep_status samestep_body_get_connected(samestep_world* world, samestep_body_id body,
                                                           const samestep_body_id** bodies, size_t* count);

enum {
  SAMESTEP_JOINT_BROKE = 0,         /* It is gone: its force or torque was more than it bears. */
  SAMESTEP_JOINT_REACHED_LOWER = 1, /* Its lower limit holds, and did not in the step before. */
  SAMESTEP_JOINT_REACHED_UPPER = 2  /* Its upper limit holds, and did not in the step before. */
};

/* What happened to a joint in the last step. */
typedef struct samestep_joint_event {
  samestep_joint_id joint;
  samestep_body_id body_a;
  samestep_body_id body_b;
  uint64_t user_data;
  samestep_vec2 force; /* On B, N. */
  double torque;       /* N m */
  int32_t change;      /* SAMESTEP_JOINT_BROKE and so on. */
  int32_t reserved;
} samestep_joint_event;

/* Whether further steps list what happens to joints, 1 or 0; 0 at first. SAMESTEP_SPACE_LOCKED. */
SAMESTEP_C_API samestep_status samestep_world_list_joint_events(samestep_world* world, int32_t joints);
/* What the last step listed of joints, by rising id. The array lives as those of samestep_world_get_events.
 */
SAMESTEP_C_API samestep_status samestep_world_get_joint_events(samestep_world* world,
                                                               const samestep_joint_event** events,
                                                               size_t* count);

/* ---- Queries ---- */

/* Which shapes a query asks about: those that the filter of a shape with these numbers would let touch it. */
typedef struct samestep_filter {
  uint32_t group;
  uint32_t category;
  uint32_t mask;
  uint32_t reserved; /* 0 */
} samestep_filter;

/* An answer of a point query. */
typedef struct samestep_point_hit {
  samestep_shape_id shape;
  samestep_vec2 point;    /* The nearest point of its surface, m. */
  double distance;        /* From there, m; negative inside. */
  samestep_vec2 gradient; /* The unit vector in which the distance grows. */
} samestep_point_hit;

/* An answer of a segment query. */
typedef struct samestep_segment_hit {
  samestep_shape_id shape;
  samestep_vec2 point;  /* Where it is hit, m. */
  samestep_vec2 normal; /* Of its surface there, a unit vector. */
  double alpha;         /* How far along the segment, 0 to 1. */
} samestep_segment_hit;

/* Queries list what they find by rising shape id, sensors included. A null filter finds all. Coordinates and
 * lengths are within 2^20 m: SAMESTEP_VALUE_OUT_OF_RANGE. */

/* The shapes within `distance` of a point. */
SAMESTEP_C_API samestep_status samestep_query_point(samestep_world* world, double x, double y,
                                                    double distance, const samestep_filter* filter,
                                                    const samestep_point_hit** hits, size_t* count);
/* The shapes that a circle of `radius` touches on its way from one point to another; radius 0: a ray with an
 * end. SAMESTEP_NEGATIVE_RADIUS. */
SAMESTEP_C_API samestep_status samestep_query_segment(samestep_world* world, double from_x, double from_y,
                                                      double to_x, double to_y, double radius,
                                                      const samestep_filter* filter,
                                                      const samestep_segment_hit** hits, size_t* count);
/* The shapes whose boxes overlap a box. SAMESTEP_NEGATIVE_HALF_DIMENSIONS. */
SAMESTEP_C_API samestep_status samestep_query_box(samestep_world* world, double left, double bottom,
                                                  double right, double top, const samestep_filter* filter,
                                                  const samestep_shape_id** hits, size_t* count);

/* A motion from part 0 to part 1: a point of a body goes straight on while the body turns about it. */
typedef struct samestep_motion {
  samestep_vec2 pivot; /* The point, in the coordinates of the body, m. */
  samestep_vec2 start; /* Its place as it begins, m. */
  samestep_vec2 way;   /* Its way, m, each component within 2^21. */
  double angle;        /* Of the body as it begins, rad. */
  double turn;         /* Of the body on the way, rad, within 2^8. */
} samestep_motion;

/* A shape near another one. */
typedef struct samestep_near_hit {
  samestep_shape_id shape;
  double distance;       /* Of the surfaces, m; negative where they overlap. */
  samestep_vec2 normal;  /* A unit vector from the shape asked about, or the first, to this one. */
  samestep_vec2 point_a; /* On the surface of the shape asked about, or the first, m. */
  samestep_vec2 point_b; /* On the surface of this one, m. */
} samestep_near_hit;

/* These write into an array of the caller's with room for `capacity` hits: the nearest first, of equals by
 * rising id. `count` is how many there are, also those that found no room; a capacity of 0 takes a null
 * array. */

/* The shapes that a circle of `radius` meets on its way from one point to another; radius 0: a ray.
 * SAMESTEP_NEGATIVE_RADIUS. */
SAMESTEP_C_API samestep_status samestep_query_cast_ray(samestep_world* world, double from_x, double from_y,
                                                       double to_x, double to_y, double radius,
                                                       const samestep_filter* filter,
                                                       samestep_segment_hit* hits, size_t capacity,
                                                       size_t* count);
/* The shapes that a shape meets on its way; alpha is the part of the motion. */
SAMESTEP_C_API samestep_status samestep_query_cast_shape(
    samestep_world* world, const samestep_shape_def* shape, const samestep_motion* motion,
    const samestep_filter* filter, samestep_segment_hit* hits, size_t capacity, size_t* count);
/* The shapes within `reach` of a shape at a place. */
SAMESTEP_C_API samestep_status samestep_query_near(samestep_world* world, const samestep_shape_def* shape,
                                                   double x, double y, double angle, double reach,
                                                   const samestep_filter* filter, samestep_near_hit* hits,
                                                   size_t capacity, size_t* count);
/* The distance of two shapes of the world. SAMESTEP_SHAPE_NOT_FOUND. */
SAMESTEP_C_API samestep_status samestep_query_distance(samestep_world* world, samestep_shape_id a,
                                                       samestep_shape_id b, samestep_near_hit* hit);

/* How two shapes touch. */
typedef struct samestep_touch {
  samestep_vec2 normal;     /* A unit vector from the first to the second; 0 where they do not touch. */
  samestep_vec2 point_a[2]; /* On the surface of the first, m. */
  samestep_vec2 point_b[2]; /* On the surface of the second, m. */
  double distance[2];       /* Along the normal, m; negative where they overlap. */
  int32_t count;            /* 0 to 2 points. */
  int32_t reserved;
} samestep_touch;

/* Whether and how two shapes touch where their bodies are now; filters do not count.
 * SAMESTEP_SHAPE_NOT_FOUND. */
SAMESTEP_C_API samestep_status samestep_query_shapes(const samestep_world* world, samestep_shape_id a,
                                                     samestep_shape_id b, samestep_touch* touch);

/* ---- Contacts and collision handlers ---- */

/* Two touching shapes. In a handler of a pair of types, A has the first; else A has the lower id. */
typedef struct samestep_contact_state {
  samestep_shape_id shape_a;
  samestep_shape_id shape_b;
  samestep_body_id body_a;
  samestep_body_id body_b;
  samestep_touch touch; /* No points in separate. */
  double friction;
  double restitution;
  samestep_vec2 surface_velocity; /* Of the surface of B against A, m/s. */
  samestep_vec2 total_impulse;    /* Of the last step on B, friction included, N s. */
  int32_t first;                  /* 1 where they began to touch in this step. */
  int32_t removal;                /* 1 in a separate that the removal of a shape or of its body calls. */
  int32_t ignored;                /* 1 where they pass through each other until they part. */
  int32_t reserved;
} samestep_contact_state;

/* What a collision handler does. A null function does what the wildcard handlers of the two shapes do, or
 * nothing. begin and pre_solve answer whether the shapes shall collide, 1 or 0: begin for as long as they
 * touch, pre_solve for this step. The world is locked: what would add or remove objects is refused with
 * SAMESTEP_SPACE_LOCKED, and belongs into a post-step function. Handlers run on the stepping thread, by
 * rising ids. */
typedef struct samestep_handler {
  int32_t (*begin)(samestep_contact* contact, samestep_world* world, void* data);
  int32_t (*pre_solve)(samestep_contact* contact, samestep_world* world, void* data);
  void (*post_solve)(samestep_contact* contact, samestep_world* world, void* data);
  void (*separate)(samestep_contact* contact, samestep_world* world, void* data);
  void* data;
} samestep_handler;

/* Registers functions under a number other than 0, or changes them. Which types a number is for is state,
 * saved and hashed; the functions are not, and a world that was saved needs them registered before it is
 * brought in. SAMESTEP_SPACE_LOCKED, SAMESTEP_VALUE_OUT_OF_RANGE. */
SAMESTEP_C_API samestep_status samestep_world_register_handler(samestep_world* world, uint32_t number,
                                                               const samestep_handler* handler);
/* For shapes of these two types, A and B in this order. Type 0 as one of them stands for every type that no
 * handler names together with the other. SAMESTEP_MISSING_CALLBACK, SAMESTEP_SPACE_LOCKED. */
SAMESTEP_C_API samestep_status samestep_world_add_handler(samestep_world* world, uint32_t type_a,
                                                          uint32_t type_b, uint32_t number);
/* For shapes of this type, as A, with any other, where no handler of the pair takes over. As above. */
SAMESTEP_C_API samestep_status samestep_world_add_wildcard_handler(samestep_world* world, uint32_t type,
                                                                   uint32_t number);
/* For pairs without a handler of their own; in place of the wildcards. As above. */
SAMESTEP_C_API samestep_status samestep_world_add_default_handler(samestep_world* world, uint32_t number);

/* All of a contact. */
SAMESTEP_C_API samestep_status samestep_contact_get(const samestep_contact* contact,
                                                    samestep_contact_state* state);
/* For this step only. SAMESTEP_NEGATIVE_FRICTION, SAMESTEP_NEGATIVE_ELASTICITY, SAMESTEP_VALUE_OUT_OF_RANGE.
 */
SAMESTEP_C_API samestep_status samestep_contact_set_friction(samestep_contact* contact, double friction);
/* For this step only. SAMESTEP_NEGATIVE_ELASTICITY, SAMESTEP_VALUE_OUT_OF_RANGE. */
SAMESTEP_C_API samestep_status samestep_contact_set_restitution(samestep_contact* contact,
                                                                double restitution);
/* Of the surface of B against A, m/s, for this step only. SAMESTEP_VALUE_OUT_OF_RANGE. */
SAMESTEP_C_API samestep_status samestep_contact_set_surface_velocity(samestep_contact* contact, double x,
                                                                     double y);
/* Replaces normal and points for this step; distances follow. SAMESTEP_IMMUTABLE_NUM_CONTACTS,
 * SAMESTEP_VALUE_OUT_OF_RANGE. */
SAMESTEP_C_API samestep_status samestep_contact_set_touch(samestep_contact* contact,
                                                          const samestep_touch* touch);
/* Lets the shapes pass through each other until they separate. */
SAMESTEP_C_API samestep_status samestep_contact_ignore(samestep_contact* contact);

/* The functions of a collision handler. */
enum { SAMESTEP_BEGIN = 0, SAMESTEP_PRE_SOLVE = 1, SAMESTEP_POST_SOLVE = 2, SAMESTEP_SEPARATE = 3 };
/* Asks the wildcard handler of one of the shapes, for a handler that wants to pass a call on: of B where of_b
 * is 1, which then sees its own shape as A. The answer is 1 where there is none. SAMESTEP_UNKNOWN_VALUE. */
SAMESTEP_C_API samestep_status samestep_contact_call_wildcard(samestep_contact* contact, int32_t phase,
                                                              int32_t of_b, int32_t* answer);

/* All touching pairs of shapes, by rising ids; of one body where `body` is not 0. SAMESTEP_BODY_NOT_FOUND. */
SAMESTEP_C_API samestep_status samestep_world_get_contacts(samestep_world* world, samestep_body_id body,
                                                           const samestep_contact_state** contacts,
                                                           size_t* count);

/* Two shapes that began to touch, or ceased to, whether there is a handler for them or not. */
typedef struct samestep_contact_event {
  samestep_shape_id shape_a; /* The lower id. */
  samestep_shape_id shape_b;
  samestep_body_id body_a;
  samestep_body_id body_b;
  int32_t sensor;  /* 1 where one of the shapes is a sensor. */
  int32_t removal; /* 1 of an end that a call between steps brought about: the shapes may be gone. */
} samestep_contact_event;

/* Two shapes that struck each other. */
typedef struct samestep_impact_event {
  samestep_shape_id shape_a; /* The lower id. */
  samestep_shape_id shape_b;
  samestep_body_id body_a;
  samestep_body_id body_b;
  samestep_vec2 point;  /* On the surface of A, of the contact point that approached fastest, m. */
  samestep_vec2 normal; /* From A to B, a unit vector. */
  double speed;         /* At which it approached when the step began, m/s. */
  double impulse;       /* Along the normal on B, of all points in the step, N s. */
} samestep_impact_event;

/* What the last step listed, by rising ids of A and B. */
typedef struct samestep_events {
  uint64_t tick; /* After that step; 0 where none has been listed. */
  const samestep_contact_event* begins;
  const samestep_contact_event* ends; /* Those that calls between the steps brought about as well. */
  const samestep_impact_event* impacts;
  uint32_t begin_count;
  uint32_t end_count;
  uint32_t impact_count;
  uint32_t reserved;
} samestep_events;

/* Says which events each further step lists, 1 or 0: beginnings and ends of contacts, and impacts of at least
 * `slowest_impact`, m/s, 0 to 2^11. None are at first, which costs nothing. No result depends on it, and no
 * saved world carries it. SAMESTEP_SPACE_LOCKED, SAMESTEP_VALUE_OUT_OF_RANGE. */
SAMESTEP_C_API samestep_status samestep_world_list_events(samestep_world* world, int32_t contacts,
                                                          int32_t impacts, double slowest_impact);
/* What the last step listed. The arrays live until the next step, or until a world is brought in, which
 * leaves nothing listed; a step that is refused leaves them as they are. */
SAMESTEP_C_API samestep_status samestep_world_get_events(samestep_world* world, samestep_events* events);

/* Moves a body in place of its velocity; samestep_body_update_position is what the engine's own does. */
typedef void (*samestep_position_function)(samestep_world* world, samestep_body_id body, double seconds,
                                           void* data);
/* Changes a velocity in place of gravity, force and torque; samestep_body_update_velocity is what the
 * engine's own does. `damping` is what is left of a velocity after this step. */
typedef void (*samestep_velocity_function)(samestep_world* world, samestep_body_id body, double gravity_x,
                                           double gravity_y, double damping, double seconds, void* data);
/* Registers a position function under a number other than 0, or changes it. SAMESTEP_SPACE_LOCKED,
 * SAMESTEP_VALUE_OUT_OF_RANGE. */
SAMESTEP_C_API samestep_status samestep_world_register_position_function(samestep_world* world,
                                                                         uint32_t number,
                                                                         samestep_position_function function,
                                                                         void* data);
/* Registers a velocity function, as samestep_world_register_position_function. */
SAMESTEP_C_API samestep_status samestep_world_register_velocity_function(samestep_world* world,
                                                                         uint32_t number,
                                                                         samestep_velocity_function function,
                                                                         void* data);
/* Moves a body by its velocities for -1 to 1 seconds; within a step it is held at the limits. */
SAMESTEP_C_API samestep_status samestep_body_update_position(samestep_world* world, samestep_body_id body,
                                                             double seconds);
/* Multiplies the velocities by `damping`, 0 to 1, and adds what gravity, force and torque do in -1 to 1
 * seconds. */
SAMESTEP_C_API samestep_status samestep_body_update_velocity(samestep_world* world, samestep_body_id body,
                                                             double gravity_x, double gravity_y,
                                                             double damping, double seconds);

/* Runs after the step or query that is under way. It may do anything but destroy the world. */
typedef void (*samestep_post_step)(samestep_world* world, uint64_t key, void* data);
/* Has a function run after the step or query that is under way, or at once if there is none; once per key
 * until then: *added is 0 if the key waits already. They run in the order in which they were added. `added`
 * may be null. Those that wait when another world is brought in, or whose step is refused, are dropped. */
SAMESTEP_C_API samestep_status samestep_world_add_post_step(samestep_world* world,
                                                            samestep_post_step function, uint64_t key,
                                                            void* data, int32_t* added);

/* ---- State ---- */

/* The hash of the state: the same on every machine for the same world. */
SAMESTEP_C_API samestep_status samestep_world_get_hash(const samestep_world* world, uint64_t* hash);
/* The hash of one body: to find where two worlds differ. SAMESTEP_BODY_NOT_FOUND. */
SAMESTEP_C_API samestep_status samestep_body_get_hash(const samestep_world* world, samestep_body_id body,
                                                      uint64_t* hash);
/* The hash of one shape. SAMESTEP_SHAPE_NOT_FOUND. */
SAMESTEP_C_API samestep_status samestep_shape_get_hash(const samestep_world* world, samestep_shape_id shape,
                                                       uint64_t* hash);

/* An empty place to save worlds of a scalar in, for rollback. SAMESTEP_UNKNOWN_VALUE,
 * SAMESTEP_SCALAR_NOT_BUILT. */
SAMESTEP_C_API samestep_status samestep_slot_create(int32_t scalar, samestep_slot** slot);
/* Null does nothing. */
SAMESTEP_C_API void samestep_slot_destroy(samestep_slot* slot);
/* Copies the world into a slot. It allocates only where the slot never held as much; functions that are
 * registered or wait are not part of it. SAMESTEP_SPACE_LOCKED, SAMESTEP_WRONG_SCALAR. */
SAMESTEP_C_API samestep_status samestep_world_save(samestep_world* world, samestep_slot* slot);
/* Brings back a saved world, as often as wanted, also one of another world. It continues exactly as the
 * original did. SAMESTEP_SPACE_LOCKED, SAMESTEP_WRONG_SCALAR, SAMESTEP_FOREIGN_WORLD where nothing was saved,
 * SAMESTEP_MISSING_CALLBACK. */
SAMESTEP_C_API samestep_status samestep_world_restore(samestep_world* world, const samestep_slot* slot);
/* The tick that a slot was saved after; 0 where nothing was saved. */
SAMESTEP_C_API samestep_status samestep_slot_get_tick(const samestep_slot* slot, uint64_t* tick);
/* How much memory a slot copies. */
SAMESTEP_C_API samestep_status samestep_slot_get_bytes(const samestep_slot* slot, uint64_t* bytes);

/* What the first bytes of a snapshot say. */
typedef struct samestep_snapshot_info {
  uint32_t format;   /* Version of the format. */
  uint32_t revision; /* Of the simulation of the build that saved it. */
  int32_t scalar;
  int32_t reserved;
  uint64_t size; /* Of the whole snapshot, bytes. */
} samestep_snapshot_info;

/* How large a world or a recording from outside may be. */
typedef struct samestep_limits {
  uint32_t version;
  uint32_t bodies;            /* Indices of bodies; 2^16 at first. */
  uint32_t shapes;            /* Indices of shapes; 2^16 at first. */
  uint32_t pairs;             /* Pairs of shapes near each other; 2^18 at first. */
  uint32_t handlers;          /* Bindings of handlers; 2^12 at first. */
  uint32_t iterations;        /* Iterations of sequential impulses; 1000 at first. */
  uint32_t substeps;          /* Substeps of the soft step; 100 at first. */
  uint32_t commands_per_tick; /* Of a recording, between two steps; 2^16 at first. */
  uint64_t bytes;             /* Of a whole recording; 2^30 at first. */
  uint64_t work; /* Of a whole replay, as samestep_world_get_work counts; without limit at first. */
} samestep_limits;

/* Sets all fields to their defaults. Null does nothing. */
SAMESTEP_C_API void samestep_limits_init(samestep_limits* limits);

/* Writes the world as bytes that every platform reads. *size is what it takes: with a null `bytes` and
 * capacity 0 only that is told; where the capacity is smaller, SAMESTEP_BUFFER_TOO_SMALL.
 * SAMESTEP_SPACE_LOCKED. */
SAMESTEP_C_API samestep_status samestep_world_write_snapshot(const samestep_world* world, uint8_t* bytes,
                                                             size_t capacity, size_t* size);
/* Brings in a snapshot in place of the world; whatever the bytes are, the world is one that could have been
 * saved or the one before. `any_revision` 1 takes the state of another revision, which goes on by the rules
 * of this one. Null limits are those of samestep_limits_init. SAMESTEP_SPACE_LOCKED,
 * SAMESTEP_MALFORMED_BYTES, SAMESTEP_OTHER_REVISION, SAMESTEP_MISSING_CALLBACK. */
SAMESTEP_C_API samestep_status samestep_world_read_snapshot(samestep_world* world, const uint8_t* bytes,
                                                            size_t size, int32_t any_revision,
                                                            const samestep_limits* limits);
/* SAMESTEP_MALFORMED_BYTES for what is no snapshot that this build reads. */
SAMESTEP_C_API samestep_status samestep_snapshot_get_info(const uint8_t* bytes, size_t size,
                                                          samestep_snapshot_info* info);

/* The fields in which two worlds differ, at most `most`, a line each: "body 7: velocity.x: 1 (...), 2 (...)";
 * "" for equal worlds. *size is what the text takes with the 0 at its end, as in
 * samestep_world_write_snapshot. SAMESTEP_WRONG_SCALAR. */
SAMESTEP_C_API samestep_status samestep_world_write_difference(const samestep_world* a,
                                                               const samestep_world* b, uint32_t most,
                                                               char* text, size_t capacity, size_t* size);

/* ---- Commands and recordings ---- */

enum {
  SAMESTEP_APPLY_IMPULSE = 0,        /* `value` N s at `arm` from the centre of mass, in world axes. */
  SAMESTEP_APPLY_FORCE = 1,          /* `value` N at `arm`, during the next step. */
  SAMESTEP_SET_VELOCITY = 2,         /* `value`, m/s. */
  SAMESTEP_SET_ANGULAR_VELOCITY = 3, /* value.x, rad/s. */
  SAMESTEP_SET_POSITION = 4,         /* `value`, m. */
  SAMESTEP_SET_ANGLE = 5,            /* value.x, rad. */
  SAMESTEP_SPAWN = 6,                /* A body with its shapes, at most 256. */
  SAMESTEP_REMOVE = 7,               /* A body and its shapes. */
  SAMESTEP_USER_INPUT = 8,           /* Bytes that only the game understands. */
  SAMESTEP_JOIN = 9,                 /* A new joint, `joined`. */
  SAMESTEP_ADJUST = 10,              /* The joint `joint` becomes `joined`. */
  SAMESTEP_UNJOIN = 11               /* Takes the joint `joint` away. */
};

/* What a player or the game does to a world between two steps. Fields that its kind does not name mean
 * nothing. */
typedef struct samestep_command {
  uint32_t version;
  int32_t kind;
  samestep_body_id body;
  samestep_vec2 value;
  samestep_vec2 arm;
  const samestep_body_def* spawned;
  const samestep_shape_def* shapes;
  const uint8_t* bytes;
  uint32_t shape_count;
  uint32_t byte_count;
  samestep_joint_id joint;
  const samestep_joint_def* joined;
} samestep_command;

/* Sets all fields to 0 but the version. Null does nothing. */
SAMESTEP_C_API void samestep_command_init(samestep_command* command);
/* Applies a command as a whole or not at all. `body` is given the id of a spawned body, else 0; it may be
 * null. SAMESTEP_WRONG_VERSION, SAMESTEP_UNKNOWN_VALUE, SAMESTEP_NULL_ARGUMENT, what the function of its name
 * is refused with, SAMESTEP_MISSING_CALLBACK for a user's input without an input function. */
SAMESTEP_C_API samestep_status samestep_world_apply(samestep_world* world, const samestep_command* command,
                                                    samestep_body_id* body);
/* Applies bytes that only the game understands: all of them, returning SAMESTEP_OK, or nothing, returning why
 * not. It goes by the bytes and the world alone. */
typedef samestep_status (*samestep_input_function)(samestep_world* world, const uint8_t* bytes, size_t size,
                                                   void* data);
/* Sets the function that applies user inputs, or null for none. */
SAMESTEP_C_API samestep_status samestep_world_set_input_function(samestep_world* world,
                                                                 samestep_input_function function,
                                                                 void* data);

/* Begins to record a world in memory that is stepped `rate` times a second, 1 to 1000000. Commands must go
 * through the recorder from now on; after samestep_world_restore to a recorded tick, the recording goes back
 * there as well. From within its own step or command, and commands while the world is locked, are refused
 * with SAMESTEP_SPACE_LOCKED. SAMESTEP_SPACE_LOCKED, SAMESTEP_VALUE_OUT_OF_RANGE, SAMESTEP_FOREIGN_WORLD for
 * a world beyond the limits, SAMESTEP_IN_USE for a world of samestep_verify. */
SAMESTEP_C_API samestep_status samestep_recorder_create(samestep_world* world, uint32_t rate,
                                                        samestep_recorder** recorder);
/* Ends a recorder before its world; null does nothing. From a function that a call of the recorder has made,
 * it ends when that call returns. */
SAMESTEP_C_API void samestep_recorder_destroy(samestep_recorder* recorder);
/* Applies a command and records it, as samestep_world_apply; SAMESTEP_FOREIGN_WORLD where the world was given
 * another one, or where checking finds a change that was not recorded. Messages are the world's. */
SAMESTEP_C_API samestep_status samestep_recorder_apply(samestep_recorder* recorder,
                                                       const samestep_command* command,
                                                       samestep_body_id* body);
/* Makes a step and records it; `hash` may be null. As samestep_world_step; SAMESTEP_FOREIGN_WORLD. */
SAMESTEP_C_API samestep_status samestep_recorder_step(samestep_recorder* recorder, uint64_t* hash);
/* How many of the last steps can be taken back, at most 32768; 240 at first. SAMESTEP_VALUE_OUT_OF_RANGE. */
SAMESTEP_C_API samestep_status samestep_recorder_set_rewind_ticks(samestep_recorder* recorder,
                                                                  uint32_t ticks);
/* Whether it looks for changes that were not recorded, for the price of a hash each: 1 or 0; 0 at first. */
SAMESTEP_C_API samestep_status samestep_recorder_set_checking(samestep_recorder* recorder, int32_t checking);
/* Ends the recording after its last step. The bytes live as long as the recorder. SAMESTEP_FOREIGN_WORLD. */
SAMESTEP_C_API samestep_status samestep_recorder_finish(samestep_recorder* recorder, const uint8_t** bytes,
                                                        size_t* size);

/* What a recorded world needs beside its bytes. */
typedef struct samestep_wiring {
  /* Registers functions with a world in which a recording is to be played; null for none. */
  void (*connect)(samestep_world* world, void* data);
  /* As samestep_world_set_input_function; null for none. */
  samestep_input_function apply_input;
  void* data;
} samestep_wiring;

/* Bits of samestep_verify_options.expected: which of its fields must hold. */
enum {
  SAMESTEP_EXPECT_FIRST_HASH = 1,
  SAMESTEP_EXPECT_RATE = 2,
  SAMESTEP_EXPECT_SCALAR = 4,
  SAMESTEP_EXPECT_TICKS = 8,
  SAMESTEP_EXPECT_FIRST_TICK = 16
};
/* How a recording is verified. */
typedef struct samestep_verify_options {
  uint32_t version;
  uint32_t expected; /* 0 at first. */
  samestep_limits limits;
  uint64_t first_hash; /* Of the world before the first step. */
  uint64_t ticks;      /* Steps in the recording. */
  uint64_t first_tick; /* Steps that its world had made before. */
  uint64_t
      most_first_tick; /* A recording whose world had made more steps is refused; a day at 60 Hz at first. */
  uint32_t rate;
  int32_t scalar;
  uint32_t commands; /* A bit (1 << kind) for each kind of command that is allowed; all at first. */
  uint32_t reserved; /* 0 */
  /* Called after each step; 0 stops. Null for none. */
  int32_t (*progress)(uint64_t done, uint64_t total, void* data);
  void* progress_data;
  samestep_interrupt interrupt; /* Asked far more often: 1 stops. Null for none. */
  void* interrupt_data;
} samestep_verify_options;

/* What replaying a recording showed. */
typedef struct samestep_verify_result {
  int32_t matches;           /* 1 where all expectations and the hash of every step hold. */
  int32_t stopped;           /* 1 where `progress` or `interrupt` ended it. */
  uint64_t ticks;            /* Steps in the recording. */
  uint64_t first_wrong_tick; /* The first step after which the hash is another one; 0: before the first. */
  uint64_t recorded_hash;    /* After that step, or the last one. */
  uint64_t computed_hash;
  char unexpected[64]; /* What of the expectations does not hold: "the scalar", "a command: position"; else
                          "". */
} samestep_verify_result;

/* Sets all fields to their defaults: nothing is expected, all commands are allowed. Null does nothing. */
SAMESTEP_C_API void samestep_verify_options_init(samestep_verify_options* options);
/* Replays a recording of either scalar and compares the hash of every step. That they differ is a result, not
 * a status. A null `wiring` registers the named handlers that scenes use; null options are those of
 * samestep_verify_options_init. SAMESTEP_WRONG_VERSION, SAMESTEP_UNKNOWN_VALUE, SAMESTEP_VALUE_OUT_OF_RANGE
 * for the rate, SAMESTEP_MALFORMED_BYTES, SAMESTEP_SCALAR_NOT_BUILT, SAMESTEP_MISSING_CALLBACK. */
SAMESTEP_C_API samestep_status samestep_verify(const uint8_t* bytes, size_t size,
                                               const samestep_wiring* wiring,
                                               const samestep_verify_options* options,
                                               samestep_verify_result* result);

/* ---- Playing recordings ---- */

/* A recording being played for somebody to look at, forth and back. */
typedef struct samestep_player samestep_player;

/* What is known of the world that a player shows. */
enum {
  SAMESTEP_PROVEN = 0,  /* It came out of the first world step by step, with the hashes of the recording. */
  SAMESTEP_CLAIMED = 1, /* It came from a keyframe beyond what was proven. */
  SAMESTEP_REFUTED = 2  /* The recording says otherwise than what came out, here or before. */
};
/* What a recording is. */
typedef struct samestep_player_info {
  uint32_t format;   /* Version of the format. */
  uint32_t revision; /* Of the simulation of the build that recorded it. */
  int32_t scalar;
  int32_t whole;  /* 0 of one that was cut; it is played as far as it goes. */
  uint64_t ticks; /* Steps in it. */
  double seconds; /* Of a step. */
} samestep_player_info;
/* Where a player stands. */
typedef struct samestep_player_state {
  uint64_t tick; /* Steps made. */
  uint64_t recorded_hash;
  uint64_t proven_ticks; /* So many steps from the start are proven. */
  uint64_t wrong_tick;   /* The first step found whose world is not the one recorded. */
  int32_t wrong;         /* 1 where there is one. */
  int32_t trust;         /* SAMESTEP_PROVEN, SAMESTEP_CLAIMED or SAMESTEP_REFUTED. */
} samestep_player_state;
/* A command of a recording. */
typedef struct samestep_player_command {
  uint64_t tick;         /* Steps made before it. */
  samestep_body_id body; /* 0 where its kind names none. */
  int32_t kind;
  int32_t reserved;
} samestep_player_command;

/* Checks a recording of either scalar, of which it keeps a copy, but no step. A null `wiring` registers the
 * named handlers that scenes use; null limits are those of samestep_limits_init. SAMESTEP_MALFORMED_BYTES,
 * SAMESTEP_SCALAR_NOT_BUILT, SAMESTEP_MISSING_CALLBACK. */
SAMESTEP_C_API samestep_status samestep_player_create(const uint8_t* bytes, size_t size,
                                                      const samestep_wiring* wiring,
                                                      const samestep_limits* limits,
                                                      samestep_player** player);
/* Null does nothing. */
SAMESTEP_C_API void samestep_player_destroy(samestep_player* player);
/* What the recording is. */
SAMESTEP_C_API samestep_status samestep_player_get_info(const samestep_player* player,
                                                        samestep_player_info* info);
/* The world as it is now, to be read and never changed; it ends with the player. */
SAMESTEP_C_API samestep_status samestep_player_get_world(samestep_player* player, samestep_world** world);
/* Where the player stands, and what is known of its world. */
SAMESTEP_C_API samestep_status samestep_player_get_state(const samestep_player* player,
                                                         samestep_player_state* state);
/* Makes the next step; *made is 0 at the end. SAMESTEP_MALFORMED_BYTES for what the world refuses. */
SAMESTEP_C_API samestep_status samestep_player_step(samestep_player* player, int32_t* made);
/* Goes to the world after a step, by way of the last keyframe before it where that is nearer than the world
 * as it is. SAMESTEP_VALUE_OUT_OF_RANGE beyond the end; SAMESTEP_MALFORMED_BYTES as samestep_player_step. */
SAMESTEP_C_API samestep_status samestep_player_seek(samestep_player* player, uint64_t tick);
/* The recorded hashes: of the first world and after each step. The array lives as long as the player. */
SAMESTEP_C_API samestep_status samestep_player_get_hashes(const samestep_player* player,
                                                          const uint64_t** hashes, size_t* count);
/* The steps after which whole worlds stand in the recording. The array lives as long as the player. */
SAMESTEP_C_API samestep_status samestep_player_get_keyframes(const samestep_player* player,
                                                             const uint64_t** ticks, size_t* count);
/* All commands in their order. The array lives as long as the player. */
SAMESTEP_C_API samestep_status samestep_player_get_commands(const samestep_player* player,
                                                            const samestep_player_command** commands,
                                                            size_t* count);
/* A command in words, by its place among all of them; *size as in samestep_world_write_snapshot, the 0 at the
 * end counted. SAMESTEP_INDEX_OUT_OF_BOUNDS. */
SAMESTEP_C_API samestep_status samestep_player_write_command(const samestep_player* player, size_t index,
                                                             char* text, size_t capacity, size_t* size);

/* ---- Sessions ---- */

/* A networked match of 2 to 16 players without a host: each peer steps its own world, and only inputs travel.
 * A session predicts what others do and takes steps back where it was wrong; docs/lockstep.md tells how. */
typedef struct samestep_session samestep_session;

/* Seats of a match are 0 to 15. */
enum { SAMESTEP_MAX_PLAYERS = 16 };

/* What one player does in one tick. */
typedef struct samestep_player_input {
  const uint8_t* held;     /* What is held, as buttons: predicted while the true input is on its way. */
  const uint8_t* commands; /* What happens once: never predicted, lost or applied twice. */
  uint32_t held_size;
  uint32_t command_size;
  int32_t present; /* 0 before the player has joined, and after it has left or was dropped. */
  int32_t reserved;
} samestep_player_input;

/* Does to the world what the players, by seat, do in a tick, before its step. It goes by the world, the
 * game's own state and the inputs alone, and does not ask what was predicted: it may be called again for a
 * tick. */
typedef void (*samestep_apply_inputs)(samestep_world* world, uint32_t tick,
                                      const samestep_player_input* players, uint32_t count, void* data);
/* Sends a datagram of at most 1200 bytes to a peer; does not wait. */
typedef void (*samestep_send)(uint64_t to, const uint8_t* bytes, size_t size, void* data);
/* Writes the next datagram that has arrived and its sender; does not wait. Answers its length, or 0 if there
 * is none; one longer than `room` is dropped. */
typedef uint32_t (*samestep_receive)(uint64_t* from, uint8_t* into, size_t room, void* data);

/* What a game keeps beside its world, as scores and timers: all three functions, or none. */
typedef struct samestep_own_state {
  void (*save)(uint32_t slot, void* data); /* Keeps it under a number below 22. */
  void (*load)(uint32_t slot, void* data); /* Brings back what was kept last under this number. */
  uint64_t (*hash)(void* data);            /* Differs where two states differ; the same on every machine. */
  void* data;
} samestep_own_state;

/* What a session is to be. Times are in microseconds. */
typedef struct samestep_session_def {
  uint32_t version;
  uint32_t match;             /* Tells this match from others that the same peers play. */
  uint32_t players;           /* 2 to 16; 2 at first. */
  uint32_t local_seat;        /* Which of them is ours. */
  uint64_t addresses[16];     /* Where the transport finds each seat: any numbers of its own. */
  uint32_t rate;              /* Steps per second; 60 at first. */
  uint32_t window;            /* Steps made ahead of the last certain one, 0 (lockstep) to 16; 8 at first. */
  uint32_t input_delay;       /* Ticks between an input and the step that uses it, 0 to 16; 2 at first. */
  uint32_t run_ahead;         /* Steps that are shown before they are made, 0 to 4; 0 at first. */
  uint32_t sparse_saving;     /* 1: the last certain step alone is saved, for worlds whose saves cost much. */
  uint32_t predicts_nothing;  /* 1: who was not heard yet is taken to hold nothing, in place of the same. */
  uint32_t max_held_bytes;    /* 1 to 64, the same for all peers; 8 at first. */
  uint32_t max_command_bytes; /* 0 to 128, the same for all peers; 32 at first. */
  uint32_t hash_interval;     /* Hashes are compared after so many steps, 0 never; 60 at first. */
  uint32_t resend_after;      /* 50000 at first. */
  uint32_t interrupted_after; /* 500000 at first. */
  uint32_t drop_after;        /* A silent peer is dropped; 3000000 at first. */
  uint32_t end_after;         /* A match without most of its players ends; 15000000 at first. */
  uint32_t gone_after;        /* When two leave at once, one waits so long for the other; 1000000 at first. */
  uint32_t paused_at_most;    /* A longer pause drops its peer; 300000000 at first. */
  uint32_t max_players;       /* Seats, `players` to 16, the same for all peers; 0: as many as `players`. */
  uint32_t joins;             /* 1 takes the local seat in a match under way, in place of starting one. */
  uint32_t reserved;          /* 0 */
  uint64_t content;           /* Of the game's own data, as a hash: peers compare it before they start. */
  samestep_apply_inputs apply_inputs;
  void* data;             /* Given to apply_inputs. */
  samestep_own_state own; /* Null functions: there is none. */
  samestep_send send;
  samestep_receive receive;
  void* transport_data; /* Given to both. */
} samestep_session_def;

/* Sets all fields to their defaults; what is called must be set. Null does nothing. */
SAMESTEP_C_API void samestep_session_def_init(samestep_session_def* def);
/* Begins a match in which the world is stepped by the session alone. Peers compare revision, fingerprint, the
 * world as it is now, its rate and `content` before they start. The world cannot be destroyed before the
 * session. SAMESTEP_WRONG_VERSION, SAMESTEP_NULL_ARGUMENT for a function, SAMESTEP_VALUE_OUT_OF_RANGE,
 * SAMESTEP_IN_USE for a world of samestep_verify. */
SAMESTEP_C_API samestep_status samestep_session_create(samestep_world* world, const samestep_session_def* def,
                                                       samestep_session** session);
/* Ends a session on this side, at once; null does nothing. From a function that a call of the session has
 * made, it ends when that call returns. Messages of its calls are the world's. */
SAMESTEP_C_API void samestep_session_destroy(samestep_session* session);

/* What came of a frame. */
enum {
  SAMESTEP_FRAME_ADVANCED = 0, /* A step was made. */
  SAMESTEP_FRAME_WAITING = 1,  /* For the inputs of others: show the last one again. */
  SAMESTEP_FRAME_PAUSED = 2,   /* A player has paused. */
  SAMESTEP_FRAME_IDLE = 3      /* The match has not begun, or has ended. */
};
/* Takes in what has arrived, takes back what was predicted wrongly, and makes a step if it may. `now` is in
 * microseconds since any moment and never goes back; `held` is what the local player holds. `frame` may be
 * null. SAMESTEP_VALUE_OUT_OF_RANGE for more than max_held_bytes, and as samestep_world_step. */
SAMESTEP_C_API samestep_status samestep_session_frame(samestep_session* session, uint64_t now,
                                                      const uint8_t* held, size_t size, int32_t* frame);
/* Only talks to the others: between two frames, and while none are made. */
SAMESTEP_C_API samestep_status samestep_session_poll(samestep_session* session, uint64_t now);
/* Queues a command of the local player for the next input with room; *queued is 0 where too many wait.
 * SAMESTEP_VALUE_OUT_OF_RANGE for one longer than max_command_bytes. */
SAMESTEP_C_API samestep_status samestep_session_command(samestep_session* session, const uint8_t* bytes,
                                                        size_t size, int32_t* queued);
/* Leaves the match with the next input; poll until its state is SAMESTEP_SESSION_ENDED. */
SAMESTEP_C_API samestep_status samestep_session_leave(samestep_session* session);
/* While a player has paused, 1, no inputs are made: all wait until 0. */
SAMESTEP_C_API samestep_status samestep_session_pause(samestep_session* session, int32_t paused);
/* From the next frame on, as in samestep_session_def; it may differ between peers.
 * SAMESTEP_VALUE_OUT_OF_RANGE. */
SAMESTEP_C_API samestep_status samestep_session_set_input_delay(samestep_session* session, uint32_t ticks);
/* The same for the steps made ahead of the last certain one. */
SAMESTEP_C_API samestep_status samestep_session_set_window(samestep_session* session, uint32_t ticks);

/* How a session stands. */
enum {
  SAMESTEP_SESSION_CONNECTING = 0, /* Some peers were not heard yet. */
  SAMESTEP_SESSION_RUNNING = 1,    /* The match is played. */
  SAMESTEP_SESSION_ENDED = 2,      /* For good. */
  SAMESTEP_SESSION_JOINING = 3     /* The state of a match under way is on its way here. */
};

/* All that a game may want to know of a session. */
typedef struct samestep_session_state {
  int32_t state;         /* SAMESTEP_SESSION_CONNECTING and so on. */
  int32_t end_reason;    /* 0 none, 1 left, 2 refused, 3 dropped, 4 minority, 5 diverged, 6 not admitted:
                            docs/lockstep.md. */
  uint32_t tick;         /* Steps made. */
  uint32_t confirmed;    /* Steps whose inputs are all known; it may be ahead of the tick. */
  uint32_t present;      /* Bit by seat: who plays now. */
  uint32_t frame_length; /* How long a frame should last, in thousandths of the usual, 950 to 1050. */
  uint64_t steps;        /* Made, repeated ones included. */
  uint64_t rollbacks;
  uint64_t saves;
  uint64_t waited; /* Frames without a step. */
  uint64_t sent_bytes;
  uint64_t sent_packets;
  uint64_t bad_packets; /* Dropped: malformed, of another match, of nobody known. */
  uint64_t lost_events; /* Not fetched in time. */
  uint32_t deepest;     /* Rollback, in steps. */
  uint32_t reserved;
} samestep_session_state;
/* How the session stands now. */
SAMESTEP_C_API samestep_status samestep_session_get_state(samestep_session* session,
                                                          samestep_session_state* state);

/* Kinds of samestep_session_event. */
enum {
  SAMESTEP_SESSION_STARTED = 0,     /* All have been heard. */
  SAMESTEP_SESSION_REFUSED = 1,     /* `seat` has another build, game or settings. */
  SAMESTEP_SESSION_INTERRUPTED = 2, /* `seat` is silent. */
  SAMESTEP_SESSION_RESUMED = 3,     /* `seat` is heard again. */
  SAMESTEP_SESSION_PAUSED = 4,      /* `seat` has paused. */
  SAMESTEP_SESSION_UNPAUSED = 5,    /* `seat` goes on. */
  SAMESTEP_SESSION_LEFT = 6,        /* `seat` has its last input at the tick before `tick`. */
  SAMESTEP_SESSION_DROPPED = 7,     /* The same, agreed by the others. */
  SAMESTEP_SESSION_DESYNC = 8, /* States after `tick` steps differ: `local_hash` here, `remote_hash` there. */
  SAMESTEP_SESSION_LOCATED = 9, /* What differs has been found: samestep_session_write_desync. */
  SAMESTEP_SESSION_OVER = 10,   /* The match has ended here. */
  SAMESTEP_SESSION_JOINED = 11, /* `seat` plays from `tick` on. */
  SAMESTEP_SESSION_LIED = 12    /* The state that `seat` sent is not the one that most players have. */
};
/* Something that the game may want to show. */
typedef struct samestep_session_event {
  int32_t kind;
  uint32_t seat;   /* 255: none. */
  uint32_t detail; /* Of a refusal: 1 protocol, 2 players, 3 settings, 4 revision, 5 fingerprint, 6 content, 7
                      seat. */
  uint32_t tick;
  uint64_t local_hash;
  uint64_t remote_hash;
} samestep_session_event;
/* Takes the oldest event, of which 64 are kept; *taken is 0 where there is none, and `event` stays as it is.
 */
SAMESTEP_C_API samestep_status samestep_session_next_event(samestep_session* session,
                                                           samestep_session_event* event, int32_t* taken);

/* What was found out about a desync, in a line; "" where there was none. *size is what the text takes with
 * the 0 at its end, as in samestep_world_write_snapshot. */
SAMESTEP_C_API samestep_status samestep_session_write_desync(samestep_session* session, char* text,
                                                             size_t capacity, size_t* size);

#ifdef __cplusplus
}
#endif

#endif
