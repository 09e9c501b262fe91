/* irdm in C: a scene that is stepped in the caller's process, and the forces of its contacts.
 *
 * SI units. Vectors are x, y, z and quaternions w, x, y, z in the world frame unless said otherwise; frames and
 * equations: docs/theory.md. All memory that is written to is the caller's.
 *
 * Errors: functions return a status and throw nothing. Wrong use (a null pointer, a number out of range) is
 * IRDM_BAD_ARGUMENT and changes nothing.
 *
 * Threads: a handle is used by one thread at a time; different handles by different threads side by side.
 * irdm_simulation_step() neither allocates, locks nor blocks; the others may.
 */
#ifndef IRDM_H
#define IRDM_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Grows when something is added, and IRDM_API_MAJOR when something that was there changes. */
#define IRDM_API_MAJOR 1
#define IRDM_API_MINOR 1

#if defined(__GNUC__)
#define IRDM_API __attribute__((visibility("default")))
#else
#define IRDM_API
#endif

typedef enum irdm_status {
  IRDM_OK = 0,
  IRDM_BAD_ARGUMENT = 1, /* wrong use */
  IRDM_FAILED = 2,       /* bad input or a lack of something: the message says what */
  IRDM_TOO_SMALL = 3     /* the caller's memory; nothing but the count is written */
} irdm_status;

/* Bits of irdm_command.buttons. */
#define IRDM_GRAB 1u
#define IRDM_RESET 2u

/* What one stylus does in a step. A command of zeros: nobody is there. */
typedef struct irdm_command {
  uint32_t present; /* 0: nobody is there, and the rest means nothing */
  uint32_t buttons;
  double tip[3];         /* at the end of the step [m] */
  double orientation[4]; /* of a stylus that leads a tool; of length 1, or all zero: not turned */
} irdm_command;

/* What became of one stylus. */
typedef struct irdm_stylus {
  int32_t present;
  int32_t contact; /* 0 free, 1 touching, 2 held */
  int32_t object;  /* that it touches; -1: none */
  int32_t tool;    /* the object that it leads; -1: none */
  double tip[3];   /* [m] */
  double proxy[3]; /* where the surface holds the tip; free: the tip [m] */
  double force[3]; /* on the stylus [N] */
  double torque[3]; /* on the stylus about its tip [N m] */
} irdm_stylus;

/* One object at the end of a step. */
typedef struct irdm_object {
  int32_t asleep;
  int32_t solved;             /* 0: the contact problem had no finite solution and no force acted */
  double position[3];         /* of the centre of mass [m] */
  double orientation[4];      /* body to world */
  double velocity[3];         /* [m/s] */
  double angular_velocity[3]; /* [rad/s] */
  double residual;            /* of the contact problem [m] */
  double energy;              /* kinetic, elastic, of gravity and tether [J]; NaN of a dense response */
} irdm_object;

/* What exerts a contact force. */
typedef enum irdm_contact_kind {
  IRDM_STYLUS = 0,
  IRDM_FLOOR = 1,
  IRDM_OBJECT = 2,
  IRDM_SCENERY = 3,
  IRDM_COUPLING = 4 /* a stylus that leads the object as its tool */
} irdm_contact_kind;

/* One force on one object. What is not known of a contact is NaN. */
typedef struct irdm_contact {
  int32_t object;     /* on which it acts */
  int32_t kind;       /* irdm_contact_kind */
  int32_t other;      /* stylus, object or scenery; 0 of the floor */
  int32_t place;      /* sample that touches an object, scenery or a stylus' ball, node on the floor, else -1 */
  int32_t state;      /* 1 touching, 2 held */
  int32_t slipping;
  double position[3]; /* [m] */
  double normal[3];   /* towards the object */
  double force[3];    /* on the object [N] */
  double slip[3];     /* of the object along the other in the step [m] */
  double area;        /* of the patch [m^2] */
} irdm_contact;

typedef struct irdm_simulation irdm_simulation;

/* Of the library: IRDM_API_MAJOR * 1000 + IRDM_API_MINOR. */
IRDM_API int32_t irdm_api_version(void);
/* Of irdm, as "0.1.0". Never freed. */
IRDM_API const char* irdm_version(void);

/* Reads a scene file with its models. *simulation is NULL where it fails.
 * message: what is wrong, ended by a zero, cut where message_size bytes are too few; may be NULL */
IRDM_API irdm_status irdm_simulation_open(const char* scene_file, irdm_simulation** simulation, char* message,
                                          size_t message_size);
/* The same of a scene's text (TOML). Relative paths start from the working directory. */
IRDM_API irdm_status irdm_simulation_parse(const char* scene_text, irdm_simulation** simulation, char* message,
                                           size_t message_size);
/* NULL: does nothing. */
IRDM_API void irdm_simulation_close(irdm_simulation* simulation);

/* Of a step [s]; NaN of NULL. */
IRDM_API double irdm_simulation_dt(const irdm_simulation* simulation);
/* -1 of NULL. */
IRDM_API int32_t irdm_simulation_stylus_count(const irdm_simulation* simulation);
IRDM_API int32_t irdm_simulation_object_count(const irdm_simulation* simulation);
/* Number of the object with this name in the scene; -1: there is none. */
IRDM_API int32_t irdm_simulation_find_object(const irdm_simulation* simulation, const char* name);

/* The next step of dt. Nothing is done where a command is wrong: tips have to be finite and within 1e4 m.
 * commands, styluses: irdm_simulation_stylus_count() each; styluses may be NULL */
IRDM_API irdm_status irdm_simulation_step(irdm_simulation* simulation, const irdm_command* commands,
                                          size_t command_count, irdm_stylus* styluses);
/* Everything is put back to the start before the next step. */
IRDM_API irdm_status irdm_simulation_reset(irdm_simulation* simulation);
/* The state as bytes: loaded, the next steps are the same to the bit. For this version of irdm on this kind of machine.
 * capacity: bytes; count: of the state, also where there is too little room; state may be NULL with capacity 0 */
IRDM_API irdm_status irdm_simulation_save(const irdm_simulation* simulation, void* state, size_t capacity,
                                          size_t* count);
/* IRDM_FAILED, and all is left as it is: the state is of other models or of another version, or damaged. */
IRDM_API irdm_status irdm_simulation_load(irdm_simulation* simulation, const void* state, size_t size, char* message,
                                          size_t message_size);

/* Of the last step; before the first one wrong use. objects: irdm_simulation_object_count() of them */
IRDM_API irdm_status irdm_simulation_objects(const irdm_simulation* simulation, irdm_object* objects, size_t capacity);
/* All forces on all objects in the last step. A contact of two objects is there for each. The sum of an object's forces
 * and its weight is the change of its momentum over dt, where it has no damping and no tether.
 * count: of the contacts, also where there is too little room; contacts may be NULL with capacity 0 */
IRDM_API irdm_status irdm_simulation_contacts(const irdm_simulation* simulation, irdm_contact* contacts,
                                              size_t capacity, size_t* count);
/* The surface nodes of an object after the last step, x, y, z each [m].
 * capacity: nodes; count: as above */
IRDM_API irdm_status irdm_simulation_surface(irdm_simulation* simulation, int32_t object, double* nodes,
                                             size_t capacity, size_t* count);
/* The triangles of its surface, three node numbers each, seen counter-clockwise from outside.
 * capacity: triangles; count: as above */
IRDM_API irdm_status irdm_simulation_triangles(const irdm_simulation* simulation, int32_t object, int32_t* triangles,
                                               size_t capacity, size_t* count);

/* A program as a stylus of a running irdm-server, by the network protocol (docs/protocol.md).
 *
 * In real time a thread of the library runs 1000 ticks a second with a bridge's link rules, contact prediction and safety
 * filter (docs/safety.md): after a lost server the force is zero within 50 ms, and the server is looked for again. In
 * lockstep, irdm_stylus_step() is a step of the server, whose force comes back unfiltered.
 *
 * Threads: irdm_stylus_set() by one thread, all else of a client by one thread, which may be another one.
 * irdm_stylus_set() and irdm_stylus_get() neither allocate, lock nor block; the others may.
 */
typedef struct irdm_stylus_client irdm_stylus_client;

/* What comes back. In real time as the safety filter shows it, in the frame of the tips set; in lockstep in the world. */
typedef struct irdm_feedback {
  int32_t ready;       /* linked, armed, and poses are set */
  int32_t contact;     /* 0 free, 1 touching, 2 held */
  double force[3];     /* on the stylus [N]; zero where it is older than 50 ms */
  double torque[3];    /* on the stylus about its tip [N m] */
  double latency;      /* age of the tip that the force answers [s]; NaN: no force yet */
  uint64_t ticks;      /* so far; in lockstep: steps */
  uint64_t late_ticks; /* that were left out, as the thread was late by more than a period */
  uint64_t sessions;   /* with a server, so far */
  double time;         /* of the tick, of CLOCK_MONOTONIC; in lockstep of the step [s] */
} irdm_feedback;

/* Connects, within the time of the option `timeout`. *client is NULL where it fails.
 * address: "HOST:PORT"
 * options: TOML; NULL: none. Keys of [bridge] (docs/configuration.md) but server, link and black_box, and
 *   tip = [x, y, z]: where the stylus is until a pose is set; required, but not in lockstep
 *   stylus: number in the scene; without it the first that is free
 *   lockstep = true, with a server that runs with --lockstep
 *   workspace, a table as of a [[device]]; not in lockstep
 *   stale_after = 0.05: a pose counts for so long [s]; then the stylus stays, is not ready, and has no force
 *   timeout = 5.0 [s]
 * message: as of irdm_simulation_open() */
IRDM_API irdm_status irdm_stylus_connect(const char* address, const char* options, irdm_stylus_client** client,
                                         char* message, size_t message_size);
/* Lets the force fade and says goodbye, in up to half a second. NULL: does nothing. */
IRDM_API void irdm_stylus_close(irdm_stylus_client* client);
/* Real time: where the stylus is from now on. Wrong use, which changes nothing: `present` is 0; a tip that is not finite or
 * not within 2 m of the origin of its frame; an orientation that is not of length 1; in lockstep. */
IRDM_API irdm_status irdm_stylus_set(irdm_stylus_client* client, const irdm_command* command);
/* The newest. */
IRDM_API irdm_status irdm_stylus_get(irdm_stylus_client* client, irdm_feedback* feedback);
/* Lockstep: the server's next step, at whose end the stylus is there. Tips are within 1000 m. Waits for the server.
 * IRDM_FAILED: the run is over. feedback may be NULL */
IRDM_API irdm_status irdm_stylus_step(irdm_stylus_client* client, const irdm_command* command, irdm_feedback* feedback);
/* What it is at, and why there is no force, ended by a zero, cut where size bytes are too few. */
IRDM_API irdm_status irdm_stylus_state(irdm_stylus_client* client, char* text, size_t size);

#ifdef __cplusplus
}
#endif

#endif
