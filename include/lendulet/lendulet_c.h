/* Lendület from C, and from everything that can call C: the boundary of the WebAssembly module is this header.
 *
 * A world is a handle. Bodies are numbers that stay valid until the body is removed and are never used again; 0 is
 * none. Whatever can be refused returns a lendulet_result: 0 or more is success, a negative number the kind of error,
 * and lendulet_error() gives the sentence that goes with it. On an error nothing has changed. A null world, and a null
 * pointer where there must be memory, are refused as well.
 *
 * read functions return how many elements there are and set a pointer to them. The memory belongs to the world and
 * holds until the next call with the same world: nothing is copied twice, and nothing has to be freed.
 *
 * Units are SI, angles are in radians, the world is right-handed, quaternions are x y z w. One world must not be used
 * by two threads at the same time.
 *
 * Worlds come from built-in scenes, or start empty and are built of bodies, shapes and joints. */
#ifndef LENDULET_C_H
#define LENDULET_C_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Number of this interface; changes where a call or a structure does. */
#define LENDULET_C_VERSION 4
uint32_t lendulet_version(void);

typedef struct lendulet_world lendulet_world;
typedef uint64_t lendulet_body;
/* As bodies: numbers of joints and of the shapes on bodies. */
typedef uint64_t lendulet_joint;
typedef uint64_t lendulet_shape;

/* >= 0: success; < 0: an error, -1 - lendulet::ErrorCode. */
typedef int32_t lendulet_result;
/* What the last refused call of this thread was refused for: one sentence, empty where none was. */
const char* lendulet_error(void);

/* --- built-in scenes ---------------------------------------------------------------------------------------------- */

int32_t lendulet_scene_count(void);
/* Name without size, one sentence, and the default size (0: the scene has none); null or 0 beyond the last scene. */
const char* lendulet_scene_name(int32_t scene);
const char* lendulet_scene_description(int32_t scene);
int32_t lendulet_scene_size(int32_t scene);

/* --- worlds ------------------------------------------------------------------------------------------------------- */

/* The built-in scene NAME or NAME:SIZE, at its start; null on an error. */
lendulet_world* lendulet_create_scene(const char* name);
/* An empty world with gravity along -y, m/s^2; null on an error. */
lendulet_world* lendulet_create_world(float gravity);
/* Ends a world; null is allowed. */
void lendulet_destroy(lendulet_world* world);

/* One step of lendulet_step_size() seconds, with what the scene does before it and with the pull of lendulet_grab(). */
lendulet_result lendulet_step(lendulet_world* world);
/* The step a scene is meant for, s; 1/60 s where nothing else is said. */
float lendulet_step_size(const lendulet_world* world);
double lendulet_time(const lendulet_world* world);         /* s simulated */
uint64_t lendulet_step_count(const lendulet_world* world); /* steps done */
/* Hash of the state: the same for every machine, compiler and number of threads, native and in WebAssembly. */
uint64_t lendulet_hash(const lendulet_world* world);
/* A second world in the same state, which goes its own way: see World::fork(). The same numbers name the same bodies
 * there. Null on an error. */
lendulet_world* lendulet_fork(const lendulet_world* world);
/* Takes memory ahead for so many bodies, contacts (0: three for every body) and joints: see World::reserve(). */
lendulet_result lendulet_reserve(lendulet_world* world, int32_t bodies, int32_t contacts, int32_t joints);
/* m/s^2 */
lendulet_result lendulet_set_gravity(lendulet_world* world, const float gravity[3]);
lendulet_result lendulet_read_gravity(const lendulet_world* world, float out[3]);

/* Everything that can be tuned while a world runs; see WorldConfig for ranges and meaning. */
typedef struct lendulet_settings {
    float gravity[3];                                      /* m/s^2 */
    float step_size;                                       /* s, above 0, at most 1 */
    int32_t solver_steps;                                  /* substeps of a step */
    int32_t broad_phase, simplex, integrator;              /* see lendulet_choice_name() */
    int32_t workers, width;                                /* threads, SIMD lanes */
    int32_t sleep, continuous;                             /* 0 or 1 */
    float friction, restitution;                           /* of what was given none of its own */
    float rigid_separation_speed, static_separation_speed; /* m/s */
} lendulet_settings;

lendulet_result lendulet_read_settings(const lendulet_world* world, lendulet_settings* out);
/* Changes them between two steps, by a fork of the world that takes its place: snapshots taken before fit no more where
 * results depend on what has changed. */
lendulet_result lendulet_set_settings(lendulet_world* world, const lendulet_settings* settings);

enum { LENDULET_BROAD_PHASES = 0, LENDULET_SIMPLEX_SOLVERS = 1, LENDULET_INTEGRATORS = 2 };
/* Name of a choice of this kind, "rtree-omt"; null beyond the last. */
const char* lendulet_choice_name(int32_t kind, int32_t choice);

/* --- bodies ------------------------------------------------------------------------------------------------------- */

typedef struct lendulet_pose {
    float position[3];
    float speed;          /* of its fastest material point, at most, m/s; -1: asleep; 0: static */
    float orientation[4]; /* x y z w */
} lendulet_pose;

/* All bodies in creation order, and their numbers in the same order. */
lendulet_result lendulet_read_poses(lendulet_world* world, const lendulet_pose** out);
lendulet_result lendulet_read_bodies(lendulet_world* world, const lendulet_body** out);

enum { LENDULET_FIXED = 0, LENDULET_KINEMATIC = 1, LENDULET_DYNAMIC = 2 };

typedef struct lendulet_body_state {
    float position[3], orientation[4];
    float centre_of_mass[3];                /* world, m */
    float velocity[3], angular_velocity[3]; /* m/s, rad/s */
    float momentum[3], angular_momentum[3]; /* kg m/s; kg m^2/s about the centre of mass */
    float mass;                             /* kg; infinite where nothing can push it */
    float kinetic_energy, potential_energy; /* J; against gravity from the origin */
    int32_t type;                           /* LENDULET_FIXED ... */
    int32_t asleep;                         /* 0 or 1 */
    char name[64];                          /* ends with a zero; cut where it is longer */
} lendulet_body_state;

lendulet_result lendulet_read_body(const lendulet_world* world, lendulet_body body, lendulet_body_state* out);

/* A body that moves. Half extents and radius in m, density in kg/m^3. `out` may be null. */
lendulet_result lendulet_add_box(lendulet_world* world, const float half_extents[3], const float position[3],
                                 const float velocity[3], float density, lendulet_body* out);
lendulet_result lendulet_add_sphere(lendulet_world* world, float radius, const float position[3],
                                    const float velocity[3], float density, lendulet_body* out);
/* A box that does not move. */
lendulet_result lendulet_add_fixed_box(lendulet_world* world, const float half_extents[3], const float position[3],
                                       lendulet_body* out);
lendulet_result lendulet_remove_body(lendulet_world* world, lendulet_body body);
/* Of any body, static ones too: see World::set_pose(). Orientations are x y z w. */
lendulet_result lendulet_set_pose(lendulet_world* world, lendulet_body body, const float at[3],
                                  const float orientation[4]);
/* Of bodies that move: see RigidBodyRef. Velocities are in m/s and rad/s. */
lendulet_result lendulet_set_velocity(lendulet_world* world, lendulet_body body, const float velocity[3]);
lendulet_result lendulet_set_angular_velocity(lendulet_world* world, lendulet_body body, const float velocity[3]);
/* N s at a point of the world. */
lendulet_result lendulet_apply_impulse(lendulet_world* world, lendulet_body body, const float impulse[3],
                                       const float point[3]);
/* N at a point of the world, and N m, both during the next step. */
lendulet_result lendulet_apply_force(lendulet_world* world, lendulet_body body, const float force[3],
                                     const float point[3]);
lendulet_result lendulet_apply_torque(lendulet_world* world, lendulet_body body, const float torque[3]);
/* Gives a kinematic body the velocities by which the next lendulet_step() takes it there. */
lendulet_result lendulet_move_to(lendulet_world* world, lendulet_body body, const float at[3],
                                 const float orientation[4]);
/* kg, of a body that was added as dynamic. */
lendulet_result lendulet_set_mass(lendulet_world* world, lendulet_body body, float mass);
/* 1/s; times the world's gravity. */
lendulet_result lendulet_set_damping(lendulet_world* world, lendulet_body body, float linear, float angular);
lendulet_result lendulet_set_gravity_factor(lendulet_world* world, lendulet_body body, float factor);

/* --- shapes: read once, and again when bodies came or went ---------------------------------------------------------
 */

enum {
    LENDULET_SPHERE = 0,           /* size: radius */
    LENDULET_CAPSULE = 1,          /* half height, radius */
    LENDULET_TAPERED_CAPSULE = 2,  /* half height, bottom radius, top radius */
    LENDULET_BOX = 3,              /* half extents */
    LENDULET_CYLINDER = 4,         /* half height, radius */
    LENDULET_TAPERED_CYLINDER = 5, /* half height, bottom radius, top radius */
    LENDULET_CONE = 6,             /* half height, radius */
    LENDULET_HULL = 7,             /* see `mesh` */
    LENDULET_PLANE = 8,            /* normal, offset: solid where dot(normal, p) <= offset */
    LENDULET_MESH = 9,             /* see `mesh` */
    LENDULET_HEIGHT_FIELD = 10     /* see `mesh`: its triangles */
};

/* A shape on a body. */
typedef struct lendulet_collider {
    int32_t body;                      /* index into the lists of bodies and poses */
    int32_t type;                      /* LENDULET_SPHERE ... */
    int32_t mesh;                      /* for lendulet_read_mesh(); -1: none */
    int32_t trigger;                   /* 1: reports overlaps only */
    float size[4];                     /* see the types above */
    float rounding;                    /* radius of the sphere swept around it */
    float position[3], orientation[4]; /* on the body */
    int32_t body_type;                 /* LENDULET_FIXED ... */
} lendulet_collider;

lendulet_result lendulet_read_colliders(lendulet_world* world, const lendulet_collider** out);

/* Surface of a hull, a mesh or a height field, shared by all colliders that have it. */
typedef struct lendulet_mesh {
    const float* vertices;   /* 3 a vertex */
    const uint32_t* indices; /* 3 a triangle, counter-clockwise from outside */
    int32_t vertex_count, triangle_count;
} lendulet_mesh;

/* After lendulet_read_colliders(). */
lendulet_result lendulet_read_mesh(lendulet_world* world, int32_t mesh, lendulet_mesh* out);

/* --- building ------------------------------------------------------------------------------------------------------
 */

/* A shape for a body that is to be added. */
typedef struct lendulet_part {
    int32_t type;                      /* LENDULET_SPHERE ... */
    int32_t mesh;                      /* hulls and meshes: what lendulet_add_hull() or lendulet_add_mesh() gave */
    int32_t trigger;                   /* 1: reports overlaps only */
    float size[4], rounding;           /* as in lendulet_collider */
    float position[3], orientation[4]; /* on the body */
    float density;                     /* kg/m^3 */
    float friction, restitution;       /* negative: the world's */
    uint32_t group;                    /* parts of the same group do not meet; 0: none */
} lendulet_part;

/* The convex hull of points (3 numbers each, m), for parts of this world: its number. */
lendulet_result lendulet_add_hull(lendulet_world* world, const float* points, int32_t count, float rounding);
/* Triangles, counter-clockwise from outside. */
lendulet_result lendulet_add_mesh(lendulet_world* world, const float* vertices, int32_t vertex_count,
                                  const uint32_t* indices, int32_t triangle_count);

typedef struct lendulet_body_definition {
    float position[3], orientation[4];
    float velocity[3], angular_velocity[3]; /* m/s, rad/s */
    float mass;                             /* kg; 0: from the densities */
    float linear_damping, angular_damping;  /* 1/s */
    float gravity_factor;
    int32_t type;  /* LENDULET_FIXED ... */
    char name[64]; /* ends with a zero */
} lendulet_body_definition;

/* `out` may be null. */
lendulet_result lendulet_add_body(lendulet_world* world, const lendulet_body_definition* definition,
                                  const lendulet_part* parts, int32_t part_count, lendulet_body* out);

enum { LENDULET_RIGID = 0, LENDULET_BALL = 1, LENDULET_HINGE = 2, LENDULET_SLIDER = 3 };

/* See JointDef: the x axis of the frames is the axis of hinges and sliders; a limit with lower > upper is none. */
typedef struct lendulet_joint_definition {
    lendulet_body body_a, body_b;
    int32_t type;                          /* LENDULET_RIGID ... */
    int32_t collide;                       /* 1: the two bodies still meet */
    float position_a[3], orientation_a[4]; /* of the joint's frame on body A */
    float position_b[3], orientation_b[4];
    float limit[2];                  /* hinge: rad, slider: m */
    float swing, twist[2];           /* ball: rad; swing > pi: free */
    float motor_velocity;            /* rad/s or m/s */
    float motor_force;               /* N m or N, at most; 0: no motor */
    float spring[2], target;         /* stiffness, damping; rad or m */
    float break_force, break_torque; /* N, N m: above these it breaks; 0: never */
} lendulet_joint_definition;

lendulet_result lendulet_add_joint(lendulet_world* world, const lendulet_joint_definition* definition);

/* Fill in what a definition should begin with: no turn, a density of 1000 kg/m^3, the world's friction and restitution,
 * gravity, free limits; a dynamic body, a sphere of 0.5 m, a ball joint. All zeros would be accepted too, and mean
 * something else: weightless, without friction, locked. */
void lendulet_default_part(lendulet_part* out);
void lendulet_default_body(lendulet_body_definition* out);
void lendulet_default_joint(lendulet_joint_definition* out);

/* --- changes -------------------------------------------------------------------------------------------------------
 */

/* The joints in creation order, the one added last as the last; and the shapes of a body. */
lendulet_result lendulet_read_joint_numbers(lendulet_world* world, const lendulet_joint** out);
lendulet_result lendulet_read_shapes(lendulet_world* world, lendulet_body body, const lendulet_shape** out);

/* Which coordinate of a joint: the only one of a hinge, slider or distance joint, or one of several, see Coordinate. */
enum {
    LENDULET_ONLY = -1,
    LENDULET_ALONG_X = 0,
    LENDULET_ALONG_Y = 1,
    LENDULET_ALONG_Z = 2,
    LENDULET_ABOUT_X = 3,
    LENDULET_ABOUT_Y = 4,
    LENDULET_ABOUT_Z = 5,
    LENDULET_DISTANCE = 6,
    LENDULET_SWING = 7
};

typedef struct lendulet_spring {
    float stiffness, damping;      /* N/m or N m/rad; N s/m or N m s/rad */
    float target, target_velocity; /* m or rad; m/s or rad/s */
    float max_force;               /* N or N m; infinity: no bound */
} lendulet_spring;

/* See World::set_motor(), set_spring() and set_limit(). */
lendulet_result lendulet_set_motor(lendulet_world* world, lendulet_joint joint, int32_t coordinate, float velocity,
                                   float max_force);
lendulet_result lendulet_set_spring(lendulet_world* world, lendulet_joint joint, int32_t coordinate,
                                    const lendulet_spring* spring);
lendulet_result lendulet_set_limit(lendulet_world* world, lendulet_joint joint, int32_t coordinate, float lower,
                                   float upper);
/* What the joint's motion meets at most, N m or N: see World::set_friction(). Of a ball joint with LENDULET_ONLY. */
lendulet_result lendulet_set_joint_friction(lendulet_world* world, lendulet_joint joint, int32_t coordinate,
                                            float friction);
/* LENDULET_KINEMATIC or LENDULET_DYNAMIC: see RigidBodyRef::set_type(). */
lendulet_result lendulet_set_body_type(lendulet_world* world, lendulet_body body, int32_t type);
lendulet_result lendulet_remove_joint(lendulet_world* world, lendulet_joint joint);

/* See Material. Negative friction and restitution are the world's. */
typedef struct lendulet_material {
    float static_friction, dynamic_friction, restitution;
    float rolling_friction, spinning_friction; /* m */
    float tangential_restitution;
    float surface_velocity[3]; /* over the body, in the shape's frame, m/s: a conveyor belt's */
} lendulet_material;
lendulet_result lendulet_set_material(lendulet_world* world, lendulet_shape shape, const lendulet_material* material);
/* See World::set_filter(). */
lendulet_result lendulet_set_filter(lendulet_world* world, lendulet_shape shape, uint64_t category, uint64_t mask,
                                    uint32_t group);

/* --- events: what the last lendulet_step() did, see lendulet/events.h ----------------------------------------------
 */

enum { LENDULET_NO_EVENTS = 0, LENDULET_CONTACT_EVENTS = 1, LENDULET_HIT_EVENTS = 2 };
/* What a shape reports from now on, the sum of some of these; nothing unless it is asked. */
lendulet_result lendulet_set_events(lendulet_world* world, lendulet_shape shape, int32_t events);

/* Two shapes. Of a trigger and what is in it A is the trigger. Numbers may be those of what is gone. */
typedef struct lendulet_touch {
    lendulet_body body_a, body_b;
    lendulet_shape shape_a, shape_b;
} lendulet_touch;

enum { LENDULET_CONTACT_BEGINS = 0, LENDULET_CONTACT_ENDS = 1, LENDULET_TRIGGER_BEGINS = 2, LENDULET_TRIGGER_ENDS = 3 };
lendulet_result lendulet_read_touches(lendulet_world* world, int32_t kind, const lendulet_touch** out);

typedef struct lendulet_blow {
    lendulet_touch touch;
    float position[3], normal[3]; /* m; from A to B */
    float speed, impulse;         /* m/s, N s */
} lendulet_blow;
lendulet_result lendulet_read_hits(lendulet_world* world, const lendulet_blow** out);

typedef struct lendulet_sleep {
    lendulet_body body;
    int64_t asleep; /* 1: fell asleep, 0: was woken */
} lendulet_sleep;
lendulet_result lendulet_read_sleep_events(lendulet_world* world, const lendulet_sleep** out);

typedef struct lendulet_break {
    lendulet_joint joint; /* which is gone */
    lendulet_body body_a, body_b;
    float force[3], torque[3]; /* on B, N and N m */
} lendulet_break;
lendulet_result lendulet_read_joint_breaks(lendulet_world* world, const lendulet_break** out);

/* --- figures -------------------------------------------------------------------------------------------------------
 */

enum { LENDULET_STAGES = 8 };
/* bounds, broad-phase, ...; null beyond the last. */
const char* lendulet_stage_name(int32_t stage);

typedef struct lendulet_statistics {
    double stage_ms[LENDULET_STAGES], total_ms; /* of the last step; 0 where there is no clock */
    double kinetic_energy, potential_energy;    /* J */
    double momentum[3], angular_momentum[3];    /* the whole world's; about its origin */
    int32_t bodies, awake_bodies, joints, pairs, manifolds, contact_points, colours;
    float max_penetration; /* m */
} lendulet_statistics;

lendulet_result lendulet_read_statistics(const lendulet_world* world, lendulet_statistics* out);

typedef struct lendulet_contact {
    float position[3];
    float separation;       /* m, negative: overlap */
    float normal[3];        /* unit, from A to B */
    float normal_impulse;   /* of the last substep, N s */
    int32_t body_a, body_b; /* indices into the list of bodies */
    int32_t manifold;       /* points of the same number have the same pair of colliders and the same normal */
    float friction_impulse; /* its length, of the whole manifold, N s */
} lendulet_contact;

/* Every contact point of the last step. */
lendulet_result lendulet_read_contacts(lendulet_world* world, const lendulet_contact** out);

/* --- the engine's own structures -----------------------------------------------------------------------------------
 */

typedef struct lendulet_joint_state {
    int32_t body_a, body_b, type;      /* indices into the list of bodies; LENDULET_RIGID ... */
    float position[3], orientation[4]; /* of the joint's frame on body A, in the world */
    float position_b[3];               /* ... and where the one on body B is */
    float orientation_b[4];
    float value, velocity;     /* hinge: rad, rad/s; slider: m, m/s */
    float limit[2];            /* lower > upper: free */
    float swing, twist[2];     /* ball */
    float force[3], torque[3]; /* on B, N and N m */
} lendulet_joint_state;

lendulet_result lendulet_read_joints(lendulet_world* world, const lendulet_joint_state** out);

/* A box of the broad phase: of a collider, or of a node of its tree. */
typedef struct lendulet_box {
    float lower[3];
    int32_t depth; /* 0: the root, and everything where there are no levels */
    float upper[3];
    int32_t leaf; /* 1: a collider's */
} lendulet_box;

lendulet_result lendulet_read_boxes(lendulet_world* world, const lendulet_box** out);

/* How each body was solved in the last step, by index. */
typedef struct lendulet_group {
    int32_t island; /* equal numbers: one island; -1: at rest or static */
    int32_t colour; /* the first colour in which one of its contacts is solved; -1: none */
} lendulet_group;

lendulet_result lendulet_read_groups(lendulet_world* world, const lendulet_group** out);

/* Conserved state of each body, by index; zero for static ones. */
typedef struct lendulet_motion {
    float centre[3], mass;             /* centre of mass, m; kg, 0 for kinematic bodies */
    float momentum[3], kinetic_energy; /* kg m/s, J */
    float angular_momentum[3];         /* about the centre of mass, kg m^2/s */
    float reach;                       /* m, of a box around it */
} lendulet_motion;

lendulet_result lendulet_read_motions(lendulet_world* world, const lendulet_motion** out);

/* --- picking and pulling -------------------------------------------------------------------------------------------
 */

typedef struct lendulet_hit {
    lendulet_body body; /* 0: nothing is met */
    float fraction;     /* of the ray */
    float point[3], normal[3];
} lendulet_hit;

/* The first body along origin + t * translation, t from 0 to 1; triggers are not seen. 1: there is one, 0: none. */
lendulet_result lendulet_cast_ray(const lendulet_world* world, const float origin[3], const float translation[3],
                                  lendulet_hit* out);

/* The first body that a convex part meets on its way along the translation, from where the part's place and turn, here
 * in the world, put it. 1: there is one, 0: none. */
lendulet_result lendulet_cast_shape(const lendulet_world* world, const lendulet_part* part, const float translation[3],
                                    lendulet_hit* out);
/* All bodies that such a part overlaps or touches, each once. */
lendulet_result lendulet_read_overlaps(lendulet_world* world, const lendulet_part* part, const lendulet_body** out);

/* Pulls a point of a dynamic body as by a damped spring: the point of the world at which it is taken rides with the
 * body, and every step pulls it towards the target of lendulet_drag(). One body at a time. */
lendulet_result lendulet_grab(lendulet_world* world, lendulet_body body, const float point[3]);
lendulet_result lendulet_drag(lendulet_world* world, const float target[3]);
/* Lets go; the body flies on with what velocity it has. */
void lendulet_release(lendulet_world* world);
/* Where the grabbed point is now: 1 and `out`, or 0 where nothing is grabbed. */
lendulet_result lendulet_read_grab(const lendulet_world* world, float out[3]);

/* --- snapshots, see World::snapshot() ------------------------------------------------------------------------------
 */

/* Returns the number of bytes. */
lendulet_result lendulet_read_snapshot(lendulet_world* world, const uint8_t** out);
/* Goes back. Bodies and joints added since are removed again, those removed since have their numbers again, as long as
 * the world remembers them: the last 4096 of either. Lets go of what is grabbed. */
lendulet_result lendulet_restore(lendulet_world* world, const uint8_t* bytes, size_t size);
/* Forgets what was removed, with its hulls and meshes: snapshots that have it are refused. */
void lendulet_forget_removed(lendulet_world* world);

#ifdef __cplusplus
}
#endif

#endif
