/* What Python and the kernel share; see kernel.c. Lengths in metres, times in seconds. */

typedef struct {
    /* Robots, n of them, all discs. */
    int n;
    double *radius, *mass, *moment, *rim, *force, *torque;
    uint8_t *in_robot_frame;
    /* Segments of walls: starts, vectors to their ends, these by their squared lengths, (s, 2) each,
       and the number of the obstacle that each belongs to. */
    int segments;
    double *start, *edge, *per_length;
    int32_t *obstacle;
    /* What the plain engine's constants are called there. */
    double max_overlap, entry, contact_step, pressed, turned;
    double slack, growth, tiny, least;
    int64_t linger, few;
    /* State: (n, 6) poses and velocities; the rest (n). */
    double *state;
    uint8_t *slipping, *engaged, *placed;
    int64_t *since;
    double *effort, *wall_gap, *moved;
    double *reach; /* how far each may move in this control step */
    double skin, last_step;
    /* The engine's objects, by address: the space; bodies, controls and joints, (n) each. */
    uintptr_t space;
    uintptr_t *body, *control, *pivot, *gear;
    /* The numbers of all bodies, obstacles below zero, sorted by their addresses. */
    int bodies;
    uintptr_t *address;
    int64_t *name;
    /* Where in the engine's structs things are, bytes. */
    size_t arbiter_count, arbiter_contacts, arbiter_state, contact_size, contact_normal, contact_tangent;
} Team;

/* The engine's functions, by address. */
typedef struct {
    uintptr_t step, set_time_step, each_arbiter, add_constraint, remove_constraint;
    uintptr_t set_position, get_position, get_angle;
    uintptr_t set_velocity, get_velocity, set_spin, get_spin;
    uintptr_t init_pivot, init_gear, set_max_force, set_max_bias, get_impulse;
    uintptr_t bodies_of, impulse_of, normal_of, count_of, point_a, point_b;
} Functions;

typedef struct Kernel Kernel;

Kernel *mars2d_kernel_new(const Team *team, const Functions *functions);
void mars2d_kernel_free(Kernel *kernel);
Team *mars2d_kernel_team(Kernel *kernel);

/* What a call of mars2d_kernel_drive may leave: robots that were placed, contacts, efforts. */
enum { MARS2D_PLACED = 1, MARS2D_CONTACTS = 2, MARS2D_EFFORT = 4 };

/* Goes on by `duration` under twists (3, n). Returns which of these there are, or -1 when memory has
   run out. */
int mars2d_kernel_drive(Kernel *kernel, const double *twist, double duration, double time);

/* How many contacts mars2d_kernel_take will give, at most. */
int mars2d_kernel_contacts(Kernel *kernel);

/* Writes the contacts since the last call, rows of the dtype CONTACT, and returns how many. */
int mars2d_kernel_take(Kernel *kernel, void *rows);

/* For tests: the sine and cosine that it uses. */
void mars2d_kernel_sines(const double *angle, int count, double *sine, double *cosine, double *hypot_of);
