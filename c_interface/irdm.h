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
#define IRDM_API_MINOR 0

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
  int32_t place;      /* patch that touches an object or scenery, surface node on the floor, else -1 */
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

#ifdef __cplusplus
}
#endif

#endif
