/* What Python and the kernel share. cffi reads this file as well, so nothing in it is for the
   preprocessor. Lengths in metres, times in seconds, the rest in SI units. */

typedef struct { double x, y; } Vector;

/* A row of the plain engine's states. */
typedef struct {
    Vector position;
    double angle;
    Vector velocity;
    double spin;
} State;

/* What pulls at a body from outside. */
typedef struct {
    Vector force;
    double torque;
} Pull;

typedef struct {
    /* Robots, n of them, all discs. */
    int n;
    double *radius, *mass, *moment, *rim, *force, *torque;
    uint8_t *in_robot_frame;
    /* Segments of walls: starts, vectors to their ends, these by their squared lengths, and the
       number of the obstacle that each belongs to. */
    int segments;
    Vector *start, *edge, *per_length;
    int32_t *obstacle;
    /* What the plain engine's constants are called there. */
    double max_overlap, entry, contact_step, pressed, turned;
    double slack, growth, tiny, least;
    int64_t linger, few;
    /* State, (n) each. */
    State *state;
    uint8_t *slipping, *engaged, *placed;
    uint8_t *pulled; /* whether each is, by what `pull` says */
    Pull *pull;
    int64_t *since;
    double *effort, *wall_gap, *moved;
    double *reach; /* how far each may move in this control step */
    double skin, last_step;
    /* In how many groups the team is stepped. With several the kernel makes spaces, bodies and joints
       of its own, by the numbers that follow, and `space` to `gear` and `address` are unused. */
    int groups, iterations;
    double slop;
    double *friction, *restitution;           /* (n) */
    double *wall_friction, *wall_restitution; /* of each segment */
    /* The engine's objects: the space; bodies, controls and joints, (n) each. */
    void *space;
    void **body, **control, **pivot, **gear;
    /* The numbers of all bodies, obstacles below zero, sorted by their addresses. */
    int bodies;
    uintptr_t *address;
    int64_t *name;
    /* Where in the engine's structs things are, bytes. */
    size_t arbiter_count, arbiter_contacts, arbiter_state;
    size_t contact_size, contact_normal, contact_tangent;
} Team;

typedef void (*Visit)(void *arbiter, void *data);

/* The engine's functions. */
typedef struct {
    void (*step)(void *space, double h);
    void (*set_time_step)(void *space, double h);
    void (*each_arbiter)(void *space, Visit visit, void *data);
    void *(*add_constraint)(void *space, void *joint);
    void (*remove_constraint)(void *space, void *joint);
    void (*set_position)(void *body, Vector position);
    Vector (*get_position)(void *body);
    double (*get_angle)(void *body);
    void (*set_velocity)(void *body, Vector velocity);
    Vector (*get_velocity)(void *body);
    void (*set_spin)(void *body, double spin);
    double (*get_spin)(void *body);
    void (*set_force)(void *body, Vector force);
    void (*set_torque)(void *body, double torque);
    void *(*init_pivot)(void *joint, void *a, void *b, Vector on_a, Vector on_b);
    void *(*init_gear)(void *joint, void *a, void *b, double phase, double ratio);
    void (*set_max_force)(void *joint, double force);
    void (*set_max_bias)(void *joint, double bias);
    double (*get_impulse)(void *joint);
    void (*bodies_of)(void *arbiter, void **a, void **b);
    Vector (*impulse_of)(void *arbiter);
    Vector (*normal_of)(void *arbiter);
    int (*count_of)(void *arbiter);
    Vector (*point_a)(void *arbiter, int contact);
    Vector (*point_b)(void *arbiter, int contact);
    void *(*new_space)(void);
    void (*set_iterations)(void *space, int iterations);
    void (*set_slop)(void *space, double slop);
    void *(*new_body)(double mass, double moment);
    void *(*new_kinematic)(void);
    void *(*new_static)(void);
    void (*set_angle)(void *body, double angle);
    void (*set_data)(void *body, void *data);
    void *(*data_of)(void *body);
    void *(*new_circle)(void *body, double radius, Vector offset);
    void *(*new_segment)(void *body, Vector a, Vector b, double radius);
    void (*set_friction)(void *shape, double friction);
    void (*set_elasticity)(void *shape, double elasticity);
    void *(*alloc_pivot)(void);
    void *(*alloc_gear)(void);
    void *(*add_body)(void *space, void *body);
    void *(*add_shape)(void *space, void *shape);
    void (*remove_body)(void *space, void *body);
    void (*remove_shape)(void *space, void *shape);
    void (*free_space)(void *space);
    void (*free_body)(void *body);
    void (*free_shape)(void *shape);
    void (*free_joint)(void *joint);
} Engine;

typedef struct Kernel Kernel;

/* Whether Python wants the control step to be broken off. */
typedef int (*Interrupted)(void);

/* Returns NULL when there is no memory. The kernel keeps the arrays' addresses, and frees none. */
Kernel *mars2d_kernel_new(const Team *team, const Engine *engine, Interrupted interrupted);
void mars2d_kernel_free(Kernel *kernel);

enum {
    /* What a control step may leave: robots that were placed, contacts, efforts. */
    MARS2D_PLACED = 1,
    MARS2D_CONTACTS = 2,
    MARS2D_EFFORT = 4,
    /* Why it was broken off: memory has run out; time can't go on, since a number is not finite or
       as good as that; Ctrl-C. The kernel then goes no further. */
    MARS2D_NO_MEMORY = -1,
    MARS2D_LOST = -2,
    MARS2D_INTERRUPTED = -3
};

/* How many robots a group has. */
int mars2d_kernel_group_size(const Kernel *kernel, int group);

/* Goes on by `duration` under twists (3, n). Returns the sum of what is left, or an error. */
int mars2d_kernel_drive(Kernel *kernel, const double *twist, double duration, double time);

/* How many contacts mars2d_kernel_take will write, or an error. */
int mars2d_kernel_contacts(Kernel *kernel);

/* Writes the contacts since the last call, rows of the dtype CONTACT; returns how many, or an error. */
int mars2d_kernel_take(Kernel *kernel, void *rows);

/* The functions of the C library that are to round as numpy's do: hypot is of an angle and its sine. */
void mars2d_kernel_sines(const double *angle, int count, double *sine, double *cosine, double *length);
