/* pindrive in C: the exact motion of a pin that friction moves, event by event. SI units throughout.
 *
 *     pindrive_drive *drive = pindrive_drive_new();
 *     pindrive_drive_set(drive, "mass", 0.010);
 *     pindrive_drive_set(drive, "stiffness", 100.0);
 *     pindrive_drive_set(drive, "damping", 0.40);
 *     pindrive_drive_set(drive, "plate.kinetic", 0.020);
 *     pindrive_drive_set(drive, "finger.kinetic", 0.005);
 *     pindrive_release *release = pindrive_release_new();
 *     pindrive_release_set(release, "mouse_velocity", 0.10);
 *     pindrive_release_set(release, "displacement", 1.5e-3);
 *     pindrive_motion *motion;
 *     if (pindrive_simulate(drive, release, NULL, NULL, &motion) != PINDRIVE_OK)
 *       fprintf(stderr, "%s\n", pindrive_last_error());
 *     double t = 0.02, x;
 *     pindrive_evaluate(motion, PINDRIVE_POSITION, &t, 1, PINDRIVE_RIGHT, &x);
 *     pindrive_motion_free(motion);
 *     pindrive_release_free(release);
 *     pindrive_drive_free(drive);
 *
 * Every function that can fail returns a pindrive_error; pindrive_last_error() then says in one line
 * what was given and what is allowed. Nothing is written to what a failed call should have filled. A
 * motion keeps no reference to the drive and the release that it was made of. Different threads may
 * use the library at once, and read one motion at once; a drive or a release is changed by one thread
 * at a time. Null pointers are allowed where it says so, and in the functions that end in _free.
 */
#ifndef PINDRIVE_H
#define PINDRIVE_H

#include <stddef.h>

/* PINDRIVE_WITHIN: within a library that has another interface to the outside, such as an FMU. */
#if defined(PINDRIVE_WITHIN)
#define PINDRIVE_API
#elif defined(_WIN32) && defined(PINDRIVE_SHARED)
#ifdef PINDRIVE_BUILDING
#define PINDRIVE_API __declspec(dllexport)
#else
#define PINDRIVE_API __declspec(dllimport)
#endif
#elif defined(__GNUC__)
#define PINDRIVE_API __attribute__((visibility("default")))
#else
#define PINDRIVE_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* The version of this interface: raised wherever a caller has to change. */
#define PINDRIVE_INTERFACE 2

/* That of the library which is running. */
PINDRIVE_API int pindrive_interface(void);

/* ---- errors ---------------------------------------------------------------------------------- */

typedef int pindrive_error;
enum {
  PINDRIVE_OK = 0,
  PINDRIVE_MORE = 1,          /* done, but there was more than fitted */
  PINDRIVE_BAD_NAME = 2,      /* nothing has that name */
  PINDRIVE_BAD_VALUE = 3,     /* a number, or a code, out of its range */
  PINDRIVE_NULL = 4,          /* a null pointer where one is needed */
  PINDRIVE_UNSUPPORTED = 5,   /* a drive and a release that the core cannot follow together */
  PINDRIVE_DERIVATIVE = 6,    /* asked of derivatives what only a motion has, or the reverse */
  PINDRIVE_STOPPED = 7,       /* go_on returned 0 */
  PINDRIVE_OUT_OF_MEMORY = 8,
  PINDRIVE_GIVEN_UP = 9 /* a stepper that cannot go on */
};

/* What the last call of this thread that failed was given, and what is allowed; valid until the next
 * one fails. Empty before. */
PINDRIVE_API const char *pindrive_last_error(void);

/* ---- drives and releases --------------------------------------------------------------------- */

/* Friction laws over the sliding speed |u|: F_c, F_c + (F_b - F_c) exp(-(|u| / v_s)^exponent),
 * F_c + (F_b - F_c) / (1 + (|u| / v_s)^2), or a curve; each with a viscous part. */
enum {
  PINDRIVE_LAW_COULOMB = 0,
  PINDRIVE_LAW_STRIBECK = 1,
  PINDRIVE_LAW_HESS_SOOM = 2,
  PINDRIVE_LAW_TABLE = 3
};

typedef struct pindrive_drive pindrive_drive;
typedef struct pindrive_release pindrive_release;

/* A drive without friction whose mass and stiffness are still to be given; null when memory is out. */
PINDRIVE_API pindrive_drive *pindrive_drive_new(void);
PINDRIVE_API void pindrive_drive_free(pindrive_drive *drive);

/* Sets a number of a drive. Names, units, and ranges, which pindrive_simulate() checks:
 *   mass              kg     > 0: of the moving body, in a device electromagnet and pin
 *   stiffness         N/m    > 0: spring
 *   damping           N s/m  >= 0
 *   plate.kinetic     N      >= 0: kinetic friction; sets plate.static too, which may follow
 *   plate.static      N      >= plate.kinetic
 *   plate.law         number of a law, at first that of Coulomb; a curve needs none
 *   plate.breakaway   N      >= plate.kinetic: at rest, where friction falls; sets plate.static too
 *   plate.stribeck_velocity  m/s > 0: over which it falls
 *   plate.exponent    1 or 2, of Stribeck's law; 1 at first
 *   plate.viscous     N s/m  >= 0: friction per sliding speed, beside each law; 0 at first
 *   finger.kinetic, finger.static and so on: the same at the finger, which is rigid where friction falls
 *   finger.stiffness  N/m    > 0: tangential; infinite: a rigid finger, as it is at first
 *   finger.damping    N s/m  >= 0: of the skin, beside its stiffness; 0 at first
 *   finger.load_exponent     0.1 to 2: the friction of the finger follows finger_load to this power; 1 at first
 *   travel            m      > 0: of the pin to its end stops, either way; infinite: none, as at first
 *   stop_stiffness    N/m    > 0: of the stops; infinite: rigid, as they are at first
 *   stop_damping      N s/m  >= 0: of elastic ones; 0 at first */
PINDRIVE_API pindrive_error pindrive_drive_set(pindrive_drive *drive, const char *name,
                                               double value);

/* Gives a contact, "plate" or "finger", a friction curve: kinetic friction forces[i] (N, >= 0) at
 * sliding speeds[i] (m/s, increasing from 0), linear between. Its kinetic friction becomes forces[0],
 * and its static friction too, which may follow. count 0 takes the curve away. */
PINDRIVE_API pindrive_error pindrive_drive_set_curve(pindrive_drive *drive, const char *contact,
                                                     const double *speeds, const double *forces,
                                                     size_t count);

/* Inputs, loads and the forces of curves are at most 1e12 in magnitude, in their units. */

/* A release at rest at the spring's rest, with a plate that stands still; null when memory is out. */
PINDRIVE_API pindrive_release *pindrive_release_new(void);
PINDRIVE_API void pindrive_release_free(pindrive_release *release);

/* Sets a number of a release. Names, units, ranges:
 *   mouse_velocity  m/s  constant velocity of the plate under the mouse
 *   plate_load           >= 0: constant factor on the plate's friction; 1 at first
 *   force           N    constant external force on the pin, the way of x; 0 at first
 *   across_velocity m/s  constant velocity of the plate across the axis; 0 at first
 *   finger_load          >= 0: constant factor on the touch of the finger; 1 at first
 *   displacement    m    x(0), from the spring's rest
 *   velocity        m/s  x'(0); NaN: the plate's, as it is at first
 *   skin_stretch    m    of a compliant finger that grips; NaN: as it slides or, at rest, none
 *   duration        s    > 0; infinite: until the ending is known, as it is at first
 *   support              0: spring fixed in the mouse, which accelerates; 1: spring on the ground */
PINDRIVE_API pindrive_error pindrive_release_set(pindrive_release *release, const char *name,
                                                 double value);

/* Gives a release "mouse_velocity", "plate_load", "force", "across_velocity" or "finger_load" over time:
 * values[i] at times[i] (s, increasing, count >= 1), linear between, constant outside. Two rows of a load
 * or a force at one time are a step: from that time on the later one holds. */
PINDRIVE_API pindrive_error pindrive_release_set_profile(pindrive_release *release,
                                                         const char *name, const double *times,
                                                         const double *values, size_t count);

/* Term of a function of time: (cosine cos(frequency tau) + sine sin(frequency tau)) exp(-decay tau),
 * with decay (1/s) from 0 to 1e9 and frequency (rad/s) from 0 to 1e7. */
typedef struct {
  double cosine, sine, decay, frequency;
} pindrive_term;

/* Piece of a function of time from `begin` (s) on: with tau = t - begin, the polynomial of degree 5 whose
 * coefficient of tau^n is polynomial[n], and `count` terms. */
typedef struct {
  double begin;
  double polynomial[6];
  const pindrive_term *terms;
  size_t count;
} pindrive_piece;

/* Gives a release "mouse_velocity", "plate_load", "force", "across_velocity" or "finger_load" as a function
 * of time: `count` >= 1 pieces, begins increasing; before the first, its value there. A velocity has no
 * jump, a load is not negative. The pieces are copied. */
PINDRIVE_API pindrive_error pindrive_release_set_function(pindrive_release *release,
                                                          const char *name,
                                                          const pindrive_piece *pieces,
                                                          size_t count);
/* Adds a function to an input of a release, whatever it was: a constant, rows or a function. */
PINDRIVE_API pindrive_error pindrive_release_add_function(pindrive_release *release,
                                                          const char *name,
                                                          const pindrive_piece *pieces,
                                                          size_t count);

/* The pieces of a function of `count` numbers, SI:
 *   "harmonic": mean, amplitude, frequency (Hz), phase (rad); mean + amplitude sin(2 pi frequency t + phase)
 *   "minimum_jerk": distance, duration, begin; the velocity of a stroke from rest to rest
 *   "exponential": start, end, time constant, begin; from start to end
 * `pieces` and `terms` have room for three each; the pieces refer to the terms. `found` of them are set. */
PINDRIVE_API pindrive_error pindrive_function(const char *kind, const double *numbers,
                                              size_t count, pindrive_piece *pieces,
                                              pindrive_term *terms, size_t *found);

/* ---- simulation ------------------------------------------------------------------------------ */

typedef struct pindrive_motion pindrive_motion;

/* Asked now and then whether to go on; 0 stops the computation. */
typedef int (*pindrive_go_on)(void *context);

/* Simulates a release; `motion` is to be freed. go_on may be null. A simulation that had to be given
 * up is no error: the motion's outcome says so. */
PINDRIVE_API pindrive_error pindrive_simulate(const pindrive_drive *drive,
                                              const pindrive_release *release,
                                              pindrive_go_on go_on, void *context,
                                              pindrive_motion **motion);

/* The exact derivatives of that motion, through its events, along a direction: every number of the
 * drive and the release changes at the rate that stands in drive_rate and release_rate, whose
 * profiles and curves have as many rows. What is then asked of `derivative` is the derivative of what
 * the motion would answer: of values at a time, of numbers, of the times of its segments. */
PINDRIVE_API pindrive_error pindrive_differentiate(const pindrive_drive *drive,
                                                   const pindrive_release *release,
                                                   const pindrive_drive *drive_rate,
                                                   const pindrive_release *release_rate,
                                                   pindrive_go_on go_on, void *context,
                                                   pindrive_motion **derivative);

/* A direction along which nothing changes: every number, and every row, of a drive or a release is 0.
 * To be changed by the functions above and freed; null when memory is out. */
PINDRIVE_API pindrive_drive *pindrive_drive_rate_new(const pindrive_drive *drive);
PINDRIVE_API pindrive_release *pindrive_release_rate_new(const pindrive_release *release);

PINDRIVE_API void pindrive_motion_free(pindrive_motion *motion);

/* Whether it was followed to its end, and what stopped it. */
typedef int pindrive_status;
enum {
  PINDRIVE_STATUS_OK = 0,
  PINDRIVE_STATUS_TOO_MANY_EVENTS = 1,
  PINDRIVE_STATUS_STANDSTILL = 2,
  PINDRIVE_STATUS_INCONSISTENT = 4,
  PINDRIVE_STATUS_TOO_MANY_PERIODS = 5
};

/* How it ends. */
typedef int pindrive_end;
enum {
  PINDRIVE_END_MOVING = 0,     /* not known within the duration */
  PINDRIVE_END_RESTING = 1,    /* at rest forever */
  PINDRIVE_END_DECAYING = 2,   /* free decay, no further event */
  PINDRIVE_END_FREE = 3,       /* undamped oscillation, no further event */
  PINDRIVE_END_GRAZING = 4,    /* the same, touching the plate's velocity once a period */
  PINDRIVE_END_STICK_SLIP = 5, /* a cycle of carried and sliding phases */
  PINDRIVE_END_LIMIT_CYCLE = 6, /* a cycle sustained by falling friction, without a carried phase */
  PINDRIVE_END_DRIVEN = 7,      /* the periodic response to periodic inputs */
  PINDRIVE_END_IRREGULAR = 8,   /* chaotic or quasi-periodic: no return within 15 360 events */
  PINDRIVE_END_DRIFTING = 9,    /* along a line, under inputs that grow for ever */
  PINDRIVE_END_GROWING = 10,    /* its range grows from period to period, without an ending in sight */
  PINDRIVE_END_APPROACHING = 11 /* a limit that is too far to be reached in 200 000 periods */
};

typedef struct pindrive_outcome {
  pindrive_status status;
  pindrive_end end;
  double steady_since; /* of a steady oscillation, s; else NaN */
  double period;       /* of a steady oscillation, s; else NaN */
  double known_until;  /* the last time at which the state is known, s; infinite once the end is */
  double simulated;    /* end of the last segment, s, where a cycle begins again ... */
  double cycle_begin;  /* ... from here, s; NaN without a cycle */
  size_t segments;
} pindrive_outcome;

PINDRIVE_API pindrive_error pindrive_outcome_of(const pindrive_motion *motion,
                                                pindrive_outcome *outcome);

/* What a status means and what to do about it. */
PINDRIVE_API const char *pindrive_status_text(pindrive_status status);

/* ---- the motion over time -------------------------------------------------------------------- */

typedef int pindrive_quantity;
enum {
  PINDRIVE_POSITION = 0,         /* m */
  PINDRIVE_VELOCITY = 1,         /* m/s */
  PINDRIVE_ACCELERATION = 2,     /* m/s^2 */
  PINDRIVE_PLATE_FORCE = 3,      /* friction of the plate on the pin, N */
  PINDRIVE_FINGER_FORCE = 4,     /* friction of the finger on the pin, N */
  PINDRIVE_SKIN_STRETCH = 5,     /* of a compliant finger, m */
  PINDRIVE_SKIN_STRETCH_RATE = 6, /* m/s */
  PINDRIVE_HOUSING_FORCE = 7,     /* of the pin on housing and finger: spring, damper, skin, stops, N */
  PINDRIVE_STOP_FORCE = 8         /* of the end stops on the pin, N */
};

/* Which limit is requested at an event. */
typedef int pindrive_side;
enum { PINDRIVE_LEFT = 0, PINDRIVE_RIGHT = 1 };

/* values[i] of a quantity at times[i] in [0, known_until]. */
PINDRIVE_API pindrive_error pindrive_evaluate(const pindrive_motion *motion,
                                              pindrive_quantity quantity, const double *times,
                                              size_t count, pindrive_side side, double *values);

/* What a contact does in a segment. */
typedef int pindrive_contact_state;
enum {
  PINDRIVE_SLIP_BACKWARD = -1,
  PINDRIVE_STICK = 0,
  PINDRIVE_SLIP_FORWARD = 1,
  PINDRIVE_ABSENT = 2,
  PINDRIVE_ELASTIC_STICK = 3,
  PINDRIVE_SLIP_OBLIQUE = 4 /* on a plate that also slides across */
};

/* What happens to a contact at an event. */
typedef int pindrive_transition;
enum {
  PINDRIVE_NONE = 0,
  PINDRIVE_STICKS = 1,
  PINDRIVE_SLIPS = 2,
  PINDRIVE_CROSSES = 3 /* its sliding velocity changes its sign */
};

/* One mode of the motion from `begin` to `end` (infinite for one that lasts forever). */
typedef struct pindrive_segment {
  double begin, end;                       /* s */
  double position, velocity, acceleration; /* at its begin: m, m/s, m/s^2 */
  double acceleration_bound; /* of a mode without a closed form, what |x''| stays below, m/s^2; else NaN */
  pindrive_contact_state plate, finger;
  int plate_branch, finger_branch;               /* of the friction curve, while it slips */
  pindrive_transition plate_event, finger_event; /* at its end */
  int stop; /* -1, 1: the lower or upper end stop touches the pin; -2, 2: the pin is beyond it, untouched */
  pindrive_transition stop_event; /* at its end: the stop meets the pin, lets it go, or throws it back */
} pindrive_segment;

/* Segment `index` of the outcome's `segments`. */
PINDRIVE_API pindrive_error pindrive_segment_of(const pindrive_motion *motion, size_t index,
                                                pindrive_segment *segment);

typedef struct pindrive_event {
  double time;               /* s */
  double position, velocity; /* m, m/s; just after the event */
  pindrive_transition plate, finger, stop;
} pindrive_event;

/* The functions that follow fill at most `capacity` entries, say in `count` how many they filled, and
 * return PINDRIVE_MORE where there were more. They ask of a motion, not of derivatives. */

/* The events in [from, to], cycles expanded. */
PINDRIVE_API pindrive_error pindrive_events(const pindrive_motion *motion, double from, double to,
                                            pindrive_event *events, size_t capacity, size_t *count);

/* Times and values of the extrema of position, velocity or acceleration in [0, until]: its begin and
 * end, where it turns, and both sides of a jump. Between two neighbours it goes one way. */
PINDRIVE_API pindrive_error pindrive_extrema(const pindrive_motion *motion,
                                             pindrive_quantity quantity, double until,
                                             double *times, double *values, size_t capacity,
                                             size_t *count);

/* Where position, velocity or acceleration changes from one side of a level to the other in
 * [0, until]: the times, and +1 or -1 for the side to which it goes. */
PINDRIVE_API pindrive_error pindrive_crossings(const pindrive_motion *motion,
                                               pindrive_quantity quantity, double level,
                                               double until, double *times, signed char *sides,
                                               size_t capacity, size_t *count);

/* ---- numbers of a motion --------------------------------------------------------------------- */

/* How many numbers a motion has, and the name of each, such as "transient.settling_time". */
PINDRIVE_API size_t pindrive_number_count(void);
PINDRIVE_API const char *pindrive_number_name(size_t index);

/* All of them over [0, duration], in that order; NaN where a motion has no such number. The duration
 * is > 0 and at most known_until; NaN: long enough to see the ending. The settling band is a part of
 * |x(0) - x_end|, in (0, 1]; 0.05 is usual. */
PINDRIVE_API pindrive_error pindrive_numbers(const pindrive_motion *motion, double duration,
                                             double settling_band, double *values);

/* The duration that NaN stands for above, s. */
PINDRIVE_API pindrive_error pindrive_duration(const pindrive_motion *motion, double settling_band,
                                              double *duration);

/* The energy ledger over [0, duration], J: the same for its entries. */
PINDRIVE_API size_t pindrive_energy_count(void);
PINDRIVE_API const char *pindrive_energy_name(size_t index);
PINDRIVE_API pindrive_error pindrive_energy(const pindrive_motion *motion, double duration,
                                            double *values);

/* The certificate over [0, duration]: how far, relative to the terms of each law, the motion is from
 * obeying it. Of a correct motion all are of the order of rounding. */
PINDRIVE_API size_t pindrive_certificate_count(void);
PINDRIVE_API const char *pindrive_certificate_name(size_t index);
PINDRIVE_API pindrive_error pindrive_certificate(const pindrive_motion *motion, double duration,
                                                 double *values);

/* ---- step by step ---------------------------------------------------------------------------- */

/* A release that is followed from one time to the next, under inputs set on the way or given over time. Its
 * answers are those of one simulation, whatever the steps: nothing is integrated again at a step. */
typedef struct pindrive_stepper pindrive_stepper;

/* A release at the time `begin`, s; to be freed. Of its mouse_velocity, plate_load, across_velocity, force
 * and finger_load, those that have one value are set on the way; those given by rows or pieces are followed,
 * and cannot be set. Its duration does not matter. */
PINDRIVE_API pindrive_error pindrive_stepper_new(const pindrive_drive *drive,
                                                 const pindrive_release *release, double begin,
                                                 pindrive_stepper **stepper);

/* The exact derivatives of that stepper along a direction, as of pindrive_differentiate(). What is then
 * evaluated of it is a derivative at a time. */
PINDRIVE_API pindrive_error pindrive_stepper_differentiate(const pindrive_drive *drive,
                                                           const pindrive_release *release,
                                                           const pindrive_drive *drive_rate,
                                                           const pindrive_release *release_rate,
                                                           double begin,
                                                           pindrive_stepper **derivative);

/* The derivatives from now on of a stepper along which nothing has changed so far: directions of its
 * inputs are then set by pindrive_stepper_set_along(). */
PINDRIVE_API pindrive_error pindrive_stepper_derivative(const pindrive_stepper *stepper,
                                                        pindrive_stepper **derivative);

/* A stepper in the same state, which continues to the same bits: it keeps a state to return to. */
PINDRIVE_API pindrive_error pindrive_stepper_copy(const pindrive_stepper *stepper,
                                                  pindrive_stepper **copy);

PINDRIVE_API void pindrive_stepper_free(pindrive_stepper *stepper);

/* Sets "mouse_velocity" or "across_velocity" (m/s, rate m/s^2), "plate_load" or "finger_load" (>= 0, rate
 * 1/s) or "force" (N, rate N/s) from now on: it continues at its rate until it is set again; a load that has
 * fallen to zero stays there. A mouse velocity that jumps moves the housing in no time: beside it the pin keeps its
 * velocity, to the plate too, unless a rigid end stop takes it along. Where the velocity across jumps the pin keeps its velocity as well, and the
 * friction turns. A value that differs from the continued input by rounding is the same. Of derivatives
 * it is a number, which does not change along the direction. */
PINDRIVE_API pindrive_error pindrive_stepper_set(pindrive_stepper *stepper, const char *input,
                                                 double value, double rate);

/* Of derivatives: how an input and its rate change along the direction, from now on. */
PINDRIVE_API pindrive_error pindrive_stepper_set_along(pindrive_stepper *derivative,
                                                       const char *input, double value,
                                                       double rate);

/* Advances to the time `until`, not before now, s; or, where stop_at_event is not 0, to the first event of
 * a contact or an end stop until then. go_on may be null; where it returns 0 the error is PINDRIVE_STOPPED,
 * now is the last event reached, and the next step continues from there. */
PINDRIVE_API pindrive_error pindrive_stepper_step(pindrive_stepper *stepper, double until,
                                                  int stop_at_event, pindrive_go_on go_on,
                                                  void *context);

typedef struct pindrive_instant {
  double time;                                   /* now, s */
  double next_event;                             /* no contact changes before it if the inputs go on
                                                    as they do, s; infinite where none ever does */
  double mouse_velocity, mouse_velocity_rate;    /* m/s, m/s^2 */
  double plate_load, plate_load_rate;            /* 1, 1/s */
  double across_velocity, across_velocity_rate;  /* m/s, m/s^2 */
  double force, force_rate;                      /* N, N/s */
  double finger_load, finger_load_rate;          /* 1, 1/s */
  pindrive_contact_state plate, finger;          /* from now on */
  pindrive_transition plate_event, finger_event; /* what happens now */
  int stop;                                      /* as in a segment */
  pindrive_transition stop_event;                /* what happens now */
} pindrive_instant;

PINDRIVE_API pindrive_error pindrive_stepper_now(const pindrive_stepper *stepper,
                                                 pindrive_instant *instant);

/* A quantity now; at an event, after it. */
PINDRIVE_API pindrive_error pindrive_stepper_evaluate(const pindrive_stepper *stepper,
                                                      pindrive_quantity quantity, double *value);

/* A stepper, not of derivatives, as bytes: how many they are, and writing them. They are read by a
 * library of the same interface on a machine that keeps numbers in the same way; damaged ones are
 * refused. */
PINDRIVE_API size_t pindrive_stepper_size(const pindrive_stepper *stepper);
PINDRIVE_API pindrive_error pindrive_stepper_write(const pindrive_stepper *stepper, void *bytes,
                                                   size_t size);
PINDRIVE_API pindrive_error pindrive_stepper_read(const void *bytes, size_t size,
                                                  pindrive_stepper **stepper);

/* ---- devices under a moving hand ------------------------------------------------------------- */

/* A value of a device file by its key ("plate.kinetic"), in SI units. rows 0: values points to a number; otherwise
 * to as many rows (x, y), such as speed and force. values null: given, but not known. */
typedef struct pindrive_given {
  const char *key;
  const double *values;
  size_t rows;
} pindrive_given;

/* Checks values of a device file: the bounds of each and what they require of each other, with `whole` also what a
 * device with magnet, control block and array requires. Writes a line for each problem into text, which has room for
 * `size` characters with the zero at its end; lines that do not fit are left out. The number of problems. */
PINDRIVE_API size_t pindrive_check_values(const pindrive_given *given, size_t count, int whole,
                                          char *text, size_t size);

/* A device of pins that electromagnets switch: a control block for each pin samples the page under its spot
 * and switches its coil, which presses pin and plate together. A hand moves the device over the page. */
typedef struct pindrive_device pindrive_device;

/* A device of one pin, without friction, whose mass and stiffness are still to be given; null when memory is
 * out. */
PINDRIVE_API pindrive_device *pindrive_device_new(void);
PINDRIVE_API void pindrive_device_free(pindrive_device *device);

/* Sets a number by its key in a device file, in SI units; pindrive_scan_new() checks its range.
 *   drive.    mass, stiffness, damping or damping_ratio, travel, stop_stiffness, stop_damping
 *   plate.    kinetic and static, or coefficient and static_coefficient; preload, touch_share
 *   finger.   kinetic and static, or coefficient and static_coefficient with touch_force
 *   finger.   stiffness, damping, load_exponent, reference_touch
 *   magnet.   hold_force, rise_time, fall_time, saturation
 *   magnet.   or in their place turns, pole_area, gap, wire_diameter, turn_length, supply_voltage,
 *   magnet.   release_resistance, saturation_field, thermal_resistance, heat_capacity
 *   magnet.   residual, pwm_frequency, pwm_duty, lift, closing_force
 *   control.  sample_rate, latency, threshold, hysteresis
 *   array.    axis: of the drives on the page, from x towards y, rad
 *   criteria. felt, direction, direction_sure, direction_speed, false_line, distinct: of a felt line
 * What is not given has the value of a device file without the key. */
PINDRIVE_API pindrive_error pindrive_device_set(pindrive_device *device, const char *key,
                                                double value);

/* Sets rows by their key: "plate.curve" and "finger.curve" (m/s, N), "plate.coefficient_curve" and
 * "finger.coefficient_curve" (m/s, 1), "magnet.voltage" (s from the command on, V; constant until the next
 * row). count 0 takes them away. */
PINDRIVE_API pindrive_error pindrive_device_set_rows(pindrive_device *device, const char *key,
                                                     const double *first, const double *second,
                                                     size_t count);

/* The unit vector (x, y) at an angle (rad) from x towards y, with the bits that the core has on every machine. */
PINDRIVE_API void pindrive_direction(double angle, double *x, double *y);

/* Sets the pins, of which each looks at the spot (x[i], y[i]) from the hand, m; at first there is one, at the
 * hand. */
PINDRIVE_API pindrive_error pindrive_device_set_pins(pindrive_device *device, const double *x,
                                                     const double *y, size_t count);

/* The motion of all pins of a device under a hand that is given row by row, as it moves. Its results do not depend
 * on the times to which it is advanced, to the bit. */
typedef struct pindrive_scan pindrive_scan;

/* Pins at rest over blank paper, magnets off, at a time (s), under a hand at a place (m) with a velocity (m/s);
 * finger_load (>= 0) is a factor of the touch, of which the plate has its share, 0 for a finger that is lifted. To be
 * freed; it keeps no reference to the device. */
PINDRIVE_API pindrive_error pindrive_scan_new(const pindrive_device *device, double time, double x,
                                              double y, double vx, double vy, double finger_load,
                                              pindrive_scan **scan);

/* A scan in the same state, which continues to the same bits. */
PINDRIVE_API pindrive_error pindrive_scan_copy(const pindrive_scan *scan, pindrive_scan **copy);
PINDRIVE_API void pindrive_scan_free(pindrive_scan *scan);

/* Sets the page from now on: luminance from 0 (black) to 1 (white), row by row from the top, `pixel` wide and high
 * (m, > 0), with its top left corner at (left, top); x goes to the right and y down. Beyond it the paper is
 * blank. The luminance is copied. */
PINDRIVE_API pindrive_error pindrive_scan_set_page(pindrive_scan *scan, const double *luminance,
                                                   size_t rows, size_t columns, double pixel,
                                                   double left, double top);

/* Moves the hand on to a later time, s, at which it has a velocity; velocity and load are linear in between, and
 * the place follows. */
PINDRIVE_API pindrive_error pindrive_scan_move(pindrive_scan *scan, double time, double vx,
                                               double vy, double finger_load);

/* Advances the pins to a time (s) that is not before now and not after the last row of the hand. go_on may be null;
 * where it returns 0 the error is PINDRIVE_STOPPED, and the next call goes on, to the same time or beyond. */
PINDRIVE_API pindrive_error pindrive_scan_advance(pindrive_scan *scan, double until,
                                                  pindrive_go_on go_on, void *context);

typedef struct pindrive_scan_instant {
  double time;      /* now, s */
  double known;     /* time of the last row of the hand, s */
  double x, y;      /* place of the hand now, m */
  double vx, vy;    /* its velocity, m/s */
  size_t pins;
} pindrive_scan_instant;

PINDRIVE_API pindrive_error pindrive_scan_now(const pindrive_scan *scan,
                                              pindrive_scan_instant *instant);

/* Quantities of a pin of a scan beside those of a motion. */
enum {
  PINDRIVE_PULL = 9,       /* of the magnet on the plate, N */
  PINDRIVE_CURRENT = 10,    /* part of the full one */
  PINDRIVE_WARMING = 11,   /* of the coil above 20 degrees Celsius, K */
  PINDRIVE_COMMAND = 12,   /* 1: to be on */
  PINDRIVE_LUMINANCE = 13  /* under its spot */
};

/* values[i] of a quantity of each pin now. */
PINDRIVE_API pindrive_error pindrive_scan_evaluate(const pindrive_scan *scan,
                                                   pindrive_quantity quantity, double *values);

/* Contacts and inputs of a pin now; its event is that of a stepper. */
PINDRIVE_API pindrive_error pindrive_scan_pin(const pindrive_scan *scan, size_t pin,
                                              pindrive_instant *instant);

typedef struct pindrive_pin_event {
  size_t pin;
  pindrive_event event;
} pindrive_pin_event;

/* Hands over the events of the pins since the last call, pin by pin for each advance, as pindrive_events() does;
 * those that did not fit follow in the next call. */
PINDRIVE_API pindrive_error pindrive_scan_events(pindrive_scan *scan, pindrive_pin_event *events,
                                                 size_t capacity, size_t *count);

/* A scan as bytes, without device, page and events: as of a stepper. It is read for an equal device, with the page
 * still to be set. */
PINDRIVE_API size_t pindrive_scan_size(const pindrive_scan *scan);
PINDRIVE_API pindrive_error pindrive_scan_write(const pindrive_scan *scan, void *bytes,
                                                size_t size);
PINDRIVE_API pindrive_error pindrive_scan_read(const pindrive_device *device, const void *bytes,
                                               size_t size, pindrive_scan **scan);

/* ---- lines that a finger feels --------------------------------------------------------------- */

/* Outcome of a printed line under a pin. */
enum {
  PINDRIVE_SHOWN = 0,
  PINDRIVE_UNSEEN = 1, /* by the control block */
  PINDRIVE_MERGED = 2, /* with the line before */
  PINDRIVE_FAINT = 3,  /* below the threshold of the finger */
  PINDRIVE_FALSE = 4   /* no printed line: a swing of the pin that the finger takes for one */
};

/* Perceived motion of the skin. */
enum {
  PINDRIVE_NO_CUE = 0,
  PINDRIVE_PULSE = 1,
  PINDRIVE_DIRECTION = 2,
  PINDRIVE_SURE_DIRECTION = 3
};

/* One end of a printed line with its response; NaN where there is none. */
typedef struct pindrive_line_edge {
  double time;     /* of passage under the spot, s */
  double x, y;     /* place of the spot, m */
  double command;  /* time of the switching of the magnet, s */
  double response; /* time of the response of the pin, s */
  double lag;      /* way of the hand from passage to response, m */
  double skin;     /* motion of the skin, m */
  int cue;
} pindrive_line_edge;

typedef struct pindrive_line {
  size_t pin;
  int outcome;
  pindrive_line_edge begin, end;
  double stroke;    /* displacement of the pin, m */
  double height;    /* largest deflection, m */
  double returned;  /* return before the next line or the stop of the hand, m */
  double release;   /* time of the break-away from the plate, s */
  double settled;   /* time from which the pin is settled, s; NaN: not settled */
  double smear;     /* way of the hand from release to settling, m */
  double overshoot; /* part of the way back */
  double contrast;
} pindrive_line;

/* Evaluates the lines under all pins against the page, for the hand as it was given from the begin of a scan that
 * was not advanced yet: line after line of each pin, then the false lines, whose `begin` has the time and the place
 * of the swing, and `height` its height; their other numbers are NaN. More than `capacity` lines make it return
 * PINDRIVE_MORE, with the number of all in `count`. go_on is as for pindrive_scan_advance. */
PINDRIVE_API pindrive_error pindrive_scan_lines(const pindrive_scan *scan, pindrive_go_on go_on,
                                                void *context, pindrive_line *lines,
                                                size_t capacity, size_t *count);

/* Pieces of the factor of the plate friction of one pin, for the hand as pindrive_scan_lines() takes it, on the
 * clock that begins with the scan; `terms` has room for two terms of each piece, and the pieces refer to it.
 * With the velocity of the hand they are the inputs of a release with the motion of the pin. More than
 * `capacity` pieces make it return PINDRIVE_MORE, with the number of all in `count`. */
PINDRIVE_API pindrive_error pindrive_scan_load(const pindrive_scan *scan, size_t pin,
                                               pindrive_piece *pieces, pindrive_term *terms,
                                               size_t capacity, size_t *count);

typedef struct pindrive_speed_limit {
  double distinct_from, distinct_to; /* first band of speeds at which both lines are felt, m/s; NaN: none */
  double settled_to; /* largest speed of the first band in which the pin settles between them, m/s; NaN: none */
  size_t bands;      /* number of bands of distinct lines */
} pindrive_speed_limit;

/* Searches for the hand speeds, from slowest to fastest (m/s, 1e-4 to 100), at which two lines of a width, a pitch
 * apart (m), are distinct for one pin: both are shown, as pindrive_scan_lines() evaluates them, and each moves
 * the skin enough for a direction, whatever the phase of the control block's samples. */
PINDRIVE_API pindrive_error pindrive_device_speed_limit(const pindrive_device *device, double pitch,
                                                        double width, double slowest,
                                                        double fastest, pindrive_go_on go_on,
                                                        void *context,
                                                        pindrive_speed_limit *limit);

/* ---- many releases --------------------------------------------------------------------------- */

/* A number of the drive or the release that is another one in each point of a batch. */
typedef struct pindrive_varied {
  const char *name;     /* as in pindrive_drive_set and pindrive_release_set */
  const double *values; /* one for each point */
} pindrive_varied;

/* Numbers of `points` releases: a drive and a release in which some numbers vary. The outputs are called as
 * by pindrive_number_name(), or "energy." and as by pindrive_energy_name(), or "duration" (s), over which a
 * release is measured, "final.position" (m) and "final.velocity" (m/s) at its end. Point i fills
 * numbers[i * output_count] and what follows it; events[i]: how often a contact changes, of a cycle in one
 * round; status[i] and end[i]; a point that cannot be simulated has an error there, which is PINDRIVE_OK
 * otherwise, and NaN for numbers. The last four may be null. Each is measured over its own duration, long
 * enough to see its ending where the release has none. */
PINDRIVE_API pindrive_error pindrive_batch(const pindrive_drive *drive,
                                           const pindrive_release *release,
                                           const pindrive_varied *varied, size_t varied_count,
                                           size_t points, double settling_band,
                                           const char *const *outputs, size_t output_count,
                                           pindrive_go_on go_on, void *context, double *numbers,
                                           int *events, pindrive_status *status,
                                           pindrive_end *end, pindrive_error *error);

#ifdef __cplusplus
}
#endif
#endif
