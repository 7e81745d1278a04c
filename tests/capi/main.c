/* The C interface, called from C: what it computes, and what it says of each mistake. */
#include "pindrive.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int failures = 0;

static void expect(int holds, const char *what) {
  if (holds) return;
  ++failures;
  printf("FAILED: %s\n", what);
}

/* That a call fails with an error, and that what it says has these words. */
static void refuses(pindrive_error error, pindrive_error expected, const char *words) {
  if (error == expected && strstr(pindrive_last_error(), words) != NULL) return;
  ++failures;
  printf("FAILED: error %d, \"%s\", not %d, \"%s\"\n", error, pindrive_last_error(),
         expected, words);
}

static pindrive_drive *the_drive(void) {
  pindrive_drive *drive = pindrive_drive_new();
  expect(pindrive_drive_set(drive, "mass", 0.010) == PINDRIVE_OK, "mass");
  expect(pindrive_drive_set(drive, "stiffness", 100.0) == PINDRIVE_OK, "stiffness");
  expect(pindrive_drive_set(drive, "damping", 0.40) == PINDRIVE_OK, "damping");
  expect(pindrive_drive_set(drive, "plate.kinetic", 0.020) == PINDRIVE_OK, "plate.kinetic");
  expect(pindrive_drive_set(drive, "finger.kinetic", 0.005) == PINDRIVE_OK, "finger.kinetic");
  return drive;
}

static pindrive_release *the_release(void) {
  pindrive_release *release = pindrive_release_new();
  expect(pindrive_release_set(release, "mouse_velocity", 0.10) == PINDRIVE_OK, "mouse_velocity");
  expect(pindrive_release_set(release, "displacement", 1.5e-3) == PINDRIVE_OK, "displacement");
  return release;
}

static pindrive_motion *run(const pindrive_drive *drive, const pindrive_release *release) {
  pindrive_motion *motion = NULL;
  expect(pindrive_simulate(drive, release, NULL, NULL, &motion) == PINDRIVE_OK, "simulate");
  return motion;
}

/* A number of a motion by its name; NaN if it has none. */
static double number(const pindrive_motion *motion, const char *name) {
  double values[64];
  size_t i;
  expect(pindrive_number_count() <= 64, "the numbers fit");
  expect(pindrive_numbers(motion, NAN, 0.05, values) == PINDRIVE_OK, "numbers");
  for (i = 0; i < pindrive_number_count(); ++i)
    if (strcmp(pindrive_number_name(i), name) == 0) return values[i];
  expect(0, name);
  return NAN;
}

static void a_motion(void) {
  pindrive_drive *drive = the_drive();
  pindrive_release *release = the_release();
  pindrive_motion *motion = run(drive, release);
  pindrive_outcome outcome;
  pindrive_segment first, last;
  pindrive_event events[64];
  double times[2] = {0, 0.02}, x[2], laws[16], energy[64], turns[64], values[64], duration;
  signed char sides[64];
  size_t i, count, all;

  /* A motion keeps no reference to what it was made of. */
  pindrive_release_free(release);
  pindrive_drive_free(drive);

  expect(pindrive_outcome_of(motion, &outcome) == PINDRIVE_OK, "outcome");
  expect(outcome.status == PINDRIVE_STATUS_OK && outcome.end == PINDRIVE_END_RESTING, "it rests");
  expect(isnan(outcome.period) && isnan(outcome.cycle_begin), "it does not oscillate for ever");
  expect(isinf(outcome.known_until), "a motion that rests is known for ever");
  expect(pindrive_segment_of(motion, 0, &first) == PINDRIVE_OK, "first segment");
  expect(first.begin == 0 && first.position == 1.5e-3, "it starts where it was released");
  expect(first.velocity == 0.10, "with the velocity of the plate");
  expect(pindrive_segment_of(motion, outcome.segments - 1, &last) == PINDRIVE_OK, "last segment");
  expect(isinf(last.end) && last.finger == PINDRIVE_STICK, "it ends at rest on the finger");

  expect(pindrive_evaluate(motion, PINDRIVE_POSITION, times, 2, PINDRIVE_RIGHT, x) == PINDRIVE_OK,
         "positions");
  expect(x[0] == 1.5e-3 && x[1] != x[0], "positions over time");
  expect(pindrive_events(motion, 0, 10, events, 64, &all) == PINDRIVE_OK && all > 0, "events");
  expect(pindrive_events(motion, 0, 10, events, 1, &count) == PINDRIVE_MORE && count == 1,
         "one event of several");
  expect(events[0].time == first.end && events[0].plate == first.plate_event, "the first event");
  expect(pindrive_extrema(motion, PINDRIVE_POSITION, 1, turns, values, 64, &count) == PINDRIVE_OK,
         "extrema");
  expect(count > 2 && values[1] == number(motion, "transient.peak_displacement"),
         "the first extremum is the peak");
  expect(pindrive_crossings(motion, PINDRIVE_VELOCITY, 0.05, 1, turns, sides, 64, &count) ==
                 PINDRIVE_OK &&
             count > 0 && sides[0] == -1,
         "the velocity falls through a level");
  expect(pindrive_duration(motion, 0.05, &duration) == PINDRIVE_OK && duration > 0, "duration");
  expect(number(motion, "transient.settling_time") < duration, "it settles");

  expect(pindrive_certificate(motion, NAN, laws) == PINDRIVE_OK, "certificate");
  for (i = 0; i < pindrive_certificate_count(); ++i)
    expect(laws[i] < 1e-12, pindrive_certificate_name(i));
  expect(pindrive_energy(motion, NAN, energy) == PINDRIVE_OK, "energy");
  for (i = 0; i < pindrive_energy_count(); ++i)
    if (strcmp(pindrive_energy_name(i), "residual") == 0)
      expect(fabs(energy[i]) < 1e-15 * energy[2], "the energy adds up");

  refuses(pindrive_segment_of(motion, outcome.segments, &last), PINDRIVE_BAD_VALUE, "one of");
  times[1] = -1;
  refuses(pindrive_evaluate(motion, PINDRIVE_POSITION, times, 2, PINDRIVE_RIGHT, x),
          PINDRIVE_BAD_VALUE, "times[1] must be");
  refuses(pindrive_evaluate(motion, 9, times, 1, PINDRIVE_RIGHT, x),
          PINDRIVE_BAD_VALUE, "a quantity must be from 0 to 8, not 9");
  refuses(pindrive_numbers(motion, -1, 0.05, values), PINDRIVE_BAD_VALUE, "duration must be");
  refuses(pindrive_numbers(motion, 1, 0, values), PINDRIVE_BAD_VALUE, "settling_band must be");
  refuses(pindrive_crossings(motion, PINDRIVE_PLATE_FORCE, 0, 1, turns, sides, 64, &count),
          PINDRIVE_BAD_VALUE, "must be position, velocity or acceleration");
  refuses(pindrive_events(motion, 0, INFINITY, events, 64, &count), PINDRIVE_BAD_VALUE,
          "to must be finite");
  refuses(pindrive_numbers(NULL, 1, 0.05, values), PINDRIVE_NULL, "motion must not be null");
  pindrive_motion_free(motion);
}

/* Derivatives along the mass, against the difference of two motions. */
static void derivatives(void) {
  const double step = 1e-6, time = 0.01;
  pindrive_drive *drive = the_drive(), *rate = pindrive_drive_rate_new(drive);
  pindrive_release *release = the_release(), *still = pindrive_release_rate_new(release);
  pindrive_motion *derivative = NULL, *less, *more;
  double slope, below, above, event;
  size_t count;
  expect(pindrive_drive_set(rate, "mass", 1) == PINDRIVE_OK, "a direction");
  expect(pindrive_differentiate(drive, release, rate, still, NULL, NULL, &derivative) ==
             PINDRIVE_OK,
         "differentiate");
  pindrive_drive_set(drive, "mass", 0.010 * (1 - step));
  less = run(drive, release);
  pindrive_drive_set(drive, "mass", 0.010 * (1 + step));
  more = run(drive, release);
  pindrive_evaluate(derivative, PINDRIVE_POSITION, &time, 1, PINDRIVE_RIGHT, &slope);
  pindrive_evaluate(less, PINDRIVE_POSITION, &time, 1, PINDRIVE_RIGHT, &below);
  pindrive_evaluate(more, PINDRIVE_POSITION, &time, 1, PINDRIVE_RIGHT, &above);
  expect(fabs(slope - (above - below) / (2 * step * 0.010)) < 1e-6 * fabs(slope),
         "the derivative of a position");
  slope = number(derivative, "transient.peak_displacement");
  below = number(less, "transient.peak_displacement");
  above = number(more, "transient.peak_displacement");
  expect(fabs(slope - (above - below) / (2 * step * 0.010)) < 1e-6 * fabs(slope),
         "the derivative of a number");
  refuses(pindrive_events(derivative, 0, 1, NULL, 0, &count), PINDRIVE_DERIVATIVE,
          "not of its derivatives");
  pindrive_release_set_profile(still, "plate_load", &time, &event, 1);
  expect(pindrive_drive_set_curve(rate, "plate", &time, &time, 1) == PINDRIVE_OK, "a curve");
  refuses(pindrive_differentiate(drive, release, rate, still, NULL, NULL, &derivative),
          PINDRIVE_BAD_VALUE, "the rate of plate.curve must have 0 rows");
  pindrive_motion_free(derivative);
  pindrive_motion_free(less);
  pindrive_motion_free(more);
  pindrive_drive_free(drive);
  pindrive_drive_free(rate);
  pindrive_release_free(release);
  pindrive_release_free(still);
}

/* Each mistake in a drive or a release is told in words. */
static void mistakes(void) {
  static const struct {
    const char *name;
    double value;
    pindrive_error error;
    const char *words;
  } cases[] = {
      {"mass", 1e-13, PINDRIVE_BAD_VALUE, "mass must be finite and at least 1e-12 kg and at most 1e12 kg"},
      {"mass", 0, PINDRIVE_BAD_VALUE, "mass must be finite and greater than 0 kg, got 0.0 kg"},
      {"stiffness", INFINITY, PINDRIVE_BAD_VALUE, "stiffness must be finite and greater than 0 N/m, got inf N/m"},
      {"damping", -1, PINDRIVE_BAD_VALUE, "damping must be finite and at least 0 N*s/m, got -1.0 N*s/m"},
      {"plate.kinetic", -0.5, PINDRIVE_BAD_VALUE, "plate.kinetic must be finite and at least 0 N, got -0.5 N"},
      {"plate.static", 0.01, PINDRIVE_BAD_VALUE, "plate.static must be at least the kinetic friction, 0.02 N, got 0.01 N"},
      {"finger.stiffness", 0, PINDRIVE_BAD_VALUE, "finger.stiffness must be finite and greater than 0 N/m"},
      {"displacement", NAN, PINDRIVE_BAD_VALUE, "displacement must be finite"},
      {"velocity", INFINITY, PINDRIVE_BAD_VALUE, "velocity must be finite, got inf m/s"},
      {"plate_load", -1, PINDRIVE_BAD_VALUE, "row 0 of plate_load must be from 0 to 1e12"},
      {"skin_stretch", 1e-3, PINDRIVE_UNSUPPORTED, "skin_stretch must be NaN for a rigid finger"},
      {"duration", 0, PINDRIVE_BAD_VALUE, "duration must be finite and greater than 0 s, got 0.0 s"},
      {"weight", 1, PINDRIVE_BAD_NAME, "has no weight, but"},
  };
  const double speeds[] = {0, 0.1, 0.05}, forces[] = {0.02, 0.01, 0.01};
  pindrive_motion *motion = NULL;
  size_t i;
  for (i = 0; i < sizeof cases / sizeof *cases; ++i) {
    pindrive_drive *drive = the_drive();
    pindrive_release *release = the_release();
    pindrive_error error = pindrive_drive_set(drive, cases[i].name, cases[i].value);
    if (error == PINDRIVE_BAD_NAME)
      error = pindrive_release_set(release, cases[i].name, cases[i].value);
    if (error == PINDRIVE_OK) error = pindrive_simulate(drive, release, NULL, NULL, &motion);
    refuses(error, cases[i].error, cases[i].words);
    expect(motion == NULL, "a refused simulation makes no motion");
    pindrive_drive_free(drive);
    pindrive_release_free(release);
  }
  {
    pindrive_drive *drive = the_drive();
    pindrive_release *release = the_release();
    pindrive_drive_set_curve(drive, "plate", speeds, forces, 3);
    refuses(pindrive_simulate(drive, release, NULL, NULL, &motion), PINDRIVE_BAD_VALUE,
            "row 2 of plate.curve must come after");
    pindrive_drive_set_curve(drive, "plate", NULL, NULL, 0);
    pindrive_drive_set_curve(drive, "plate", speeds, forces, 2);
    pindrive_drive_set(drive, "plate.kinetic", 0.03);
    refuses(pindrive_simulate(drive, release, NULL, NULL, &motion), PINDRIVE_BAD_VALUE,
            "plate.kinetic must be the first force of its curve");
    refuses(pindrive_drive_set_curve(drive, "thumb", speeds, forces, 2), PINDRIVE_BAD_NAME,
            "the contacts plate and finger");
    refuses(pindrive_release_set_profile(release, "displacement", speeds, forces, 2),
            PINDRIVE_BAD_NAME, "the inputs mouse_velocity, plate_load, force, across_velocity and finger_load");
    refuses(pindrive_simulate(NULL, release, NULL, NULL, &motion), PINDRIVE_NULL, "drive");
    pindrive_drive_free(drive);
    pindrive_release_free(release);
  }
}

/* The position at a time to which steps lead. */
static double position_after(pindrive_stepper *stepper, double until, double step) {
  pindrive_instant now;
  double x = NAN;
  expect(pindrive_stepper_now(stepper, &now) == PINDRIVE_OK, "now");
  while (now.time < until) {
    const double next = now.time + step < until ? now.time + step : until;
    expect(pindrive_stepper_step(stepper, next, 0, NULL, NULL) == PINDRIVE_OK, "step");
    expect(pindrive_stepper_now(stepper, &now) == PINDRIVE_OK, "now");
  }
  expect(pindrive_stepper_evaluate(stepper, PINDRIVE_POSITION, &x) == PINDRIVE_OK, "position");
  return x;
}

static int never(void *context) {
  ++*(int *)context;
  return 0;
}

/* Next to no friction and no damping: a motion of very many events, which its caller stops. */
static void stopping(void) {
  pindrive_drive *drive = the_drive();
  pindrive_release *release = the_release();
  pindrive_motion *motion = NULL;
  pindrive_stepper *stepper = NULL, *other = NULL;
  pindrive_instant now;
  double until;
  int asked = 0;
  pindrive_drive_set(drive, "damping", 0);
  pindrive_drive_set(drive, "plate.kinetic", 0);
  pindrive_drive_set(drive, "finger.kinetic", 1e-9);
  refuses(pindrive_simulate(drive, release, never, &asked, &motion), PINDRIVE_STOPPED, "stopped");
  expect(asked == 1 && motion == NULL, "it is asked once and makes no motion");
  expect(pindrive_stepper_new(drive, release, 0, &stepper) == PINDRIVE_OK, "its stepper");
  expect(pindrive_stepper_new(drive, release, 0, &other) == PINDRIVE_OK, "another one");
  refuses(pindrive_stepper_step(stepper, 1e6, 0, never, &asked), PINDRIVE_STOPPED, "stopped");
  expect(pindrive_stepper_now(stepper, &now) == PINDRIVE_OK && now.time > 0 && now.time < 1e6,
         "it stopped at an event");
  until = now.time + 0.1;
  expect(position_after(stepper, until, 0.01) == position_after(other, until, 1),
         "and continues as if it had not");
  pindrive_stepper_free(stepper);
  pindrive_stepper_free(other);
  pindrive_drive_free(drive);
  pindrive_release_free(release);
}

static void a_batch(void) {
  const double masses[3] = {0.008, -1, 0.012};
  const pindrive_varied varied = {"mass", masses}, unknown = {"weight", masses};
  const char *const outputs[3] = {pindrive_number_name(0), "energy.spring_start", "final.position"};
  const char *const no_output = "energy.none";
  double numbers[9];
  int events[3];
  pindrive_status status[3];
  pindrive_end end[3];
  pindrive_error error[3];
  pindrive_drive *drive = the_drive();
  pindrive_release *release = the_release();
  pindrive_motion *motion;
  expect(pindrive_batch(drive, release, &varied, 1, 3, 0.05, outputs, 3, NULL, NULL, numbers, events,
                        status, end, error) == PINDRIVE_OK,
         "batch");
  expect(error[0] == PINDRIVE_OK && error[1] == PINDRIVE_BAD_VALUE && error[2] == PINDRIVE_OK,
         "one point is refused");
  expect(isnan(numbers[3]) && events[1] == 0 && end[2] == PINDRIVE_END_RESTING, "and has no numbers");
  pindrive_drive_set(drive, "mass", 0.012);
  motion = run(drive, release);
  expect(fabs(numbers[6] / number(motion, outputs[0]) - 1) < 1e-14, "as one motion has it");
  expect(fabs(numbers[8] / number(motion, "ending.position") - 1) < 1e-14, "where it ends");
  expect(events[2] > 0, "and its events");
  refuses(pindrive_batch(drive, release, &unknown, 1, 3, 0.05, outputs, 3, NULL, NULL, numbers, NULL,
                         NULL, NULL, NULL),
          PINDRIVE_BAD_NAME, "neither a drive nor a release has weight");
  refuses(pindrive_batch(drive, release, &varied, 1, 3, 0.05, &no_output, 1, NULL, NULL, numbers,
                         NULL, NULL, NULL, NULL),
          PINDRIVE_BAD_NAME, "a batch has no number energy.none");
  pindrive_motion_free(motion);
  pindrive_drive_free(drive);
  pindrive_release_free(release);
}

static void stepping(void) {
  const double times[2] = {0, 0.03}, velocities[2] = {0.10, 0.01}, t = 0.02;
  pindrive_drive *drive = the_drive(), *rate = pindrive_drive_rate_new(drive);
  pindrive_release *release = the_release(), *still = pindrive_release_rate_new(release);
  pindrive_motion *motion, *derivative = NULL;
  pindrive_stepper *stepper = NULL, *copy = NULL, *read = NULL, *along = NULL, *other = NULL;
  pindrive_instant now;
  pindrive_segment first;
  unsigned char *bytes;
  size_t size;
  double x, y;
  expect(pindrive_stepper_new(drive, release, 0, &stepper) == PINDRIVE_OK, "a stepper");
  expect(pindrive_stepper_set(stepper, "mouse_velocity", 0.10, -3.0) == PINDRIVE_OK, "an input");
  pindrive_drive_set(rate, "mass", 1);
  expect(pindrive_stepper_differentiate(drive, release, rate, still, 0, &along) == PINDRIVE_OK,
         "its derivatives");
  expect(pindrive_stepper_set(along, "mouse_velocity", 0.10, -3.0) == PINDRIVE_OK, "an input");
  expect(pindrive_stepper_copy(stepper, &copy) == PINDRIVE_OK, "a copy");
  x = position_after(stepper, t, 1e-3);
  expect(x == position_after(copy, t, 7e-4), "any steps lead to the same bits");

  expect(pindrive_release_set_profile(release, "mouse_velocity", times, velocities, 2) ==
             PINDRIVE_OK,
         "the same as a profile");
  motion = run(drive, release);
  pindrive_evaluate(motion, PINDRIVE_POSITION, &t, 1, PINDRIVE_RIGHT, &y);
  expect(fabs(x - y) < 1e-15 * fabs(y), "those of one simulation");
  pindrive_release_free(still);
  still = pindrive_release_rate_new(release);
  expect(pindrive_differentiate(drive, release, rate, still, NULL, NULL, &derivative) ==
             PINDRIVE_OK,
         "its derivatives");
  pindrive_evaluate(derivative, PINDRIVE_POSITION, &t, 1, PINDRIVE_RIGHT, &y);
  expect(fabs(position_after(along, t, 1e-3) - y) < 1e-12 * fabs(y), "and its derivatives");

  size = pindrive_stepper_size(stepper);
  bytes = malloc(size);
  expect(pindrive_stepper_write(stepper, bytes, size) == PINDRIVE_OK, "written");
  expect(pindrive_stepper_read(bytes, size, &read) == PINDRIVE_OK, "read");
  x = position_after(stepper, 0.05, 1e-2);
  expect(position_after(read, 0.05, 3e-3) == x, "from bytes it goes on in the same way");
  expect(pindrive_stepper_derivative(stepper, &other) == PINDRIVE_OK, "derivatives from now on");
  expect(pindrive_stepper_set_along(other, "mouse_velocity", 0, 1) == PINDRIVE_OK, "an input");
  expect(pindrive_stepper_evaluate(other, PINDRIVE_ACCELERATION, &y) == PINDRIVE_OK && y == 1,
         "the housing's acceleration is the pin's");
  pindrive_stepper_free(copy);
  pindrive_release_set(release, "mouse_velocity", 0.10);
  pindrive_release_set(release, "across_velocity", 0.02);
  pindrive_release_set(release, "force", 0.01);
  expect(pindrive_stepper_new(drive, release, 0, &copy) == PINDRIVE_OK, "one across, with a force");
  expect(pindrive_stepper_now(copy, &now) == PINDRIVE_OK && now.plate == PINDRIVE_SLIP_OBLIQUE &&
             now.across_velocity == 0.02 && now.force == 0.01 && now.force_rate == 0,
         "its plate slips across");
  expect(pindrive_stepper_set(copy, "force", 0.02, 1) == PINDRIVE_OK &&
             pindrive_stepper_set(copy, "across_velocity", 0, 0) == PINDRIVE_OK &&
             pindrive_stepper_now(copy, &now) == PINDRIVE_OK && now.plate == PINDRIVE_SLIP_BACKWARD &&
             now.force == 0.02 && now.force_rate == 1,
         "until that stops");
  pindrive_stepper_free(copy);
  pindrive_release_set(release, "across_velocity", 0);
  pindrive_release_set(release, "force", 0);
  expect(pindrive_stepper_new(drive, release, 0, &copy) == PINDRIVE_OK, "another one");
  pindrive_motion_free(motion);
  motion = run(drive, release);
  pindrive_segment_of(motion, 0, &first);
  expect(pindrive_stepper_now(copy, &now) == PINDRIVE_OK && now.next_event == first.end,
         "it knows its next event");
  expect(pindrive_stepper_step(copy, 1, 1, NULL, NULL) == PINDRIVE_OK, "to the next event");
  expect(pindrive_stepper_now(copy, &now) == PINDRIVE_OK && now.time == first.end &&
             now.finger_event == first.finger_event,
         "where it stops");

  refuses(pindrive_stepper_step(copy, 0, 0, NULL, NULL), PINDRIVE_BAD_VALUE, "until must be finite");
  refuses(pindrive_stepper_set(copy, "plate_load", -1, 0), PINDRIVE_BAD_VALUE,
          "plate_load must be from 0 to 1e12, not -1");
  refuses(pindrive_stepper_set(copy, "mouse_velocity", 0, INFINITY), PINDRIVE_BAD_VALUE,
          "rate must be finite");
  refuses(pindrive_stepper_set(copy, "mass", 1, 0), PINDRIVE_BAD_NAME, "has no input mass");
  refuses(pindrive_stepper_set_along(copy, "plate_load", 1, 0), PINDRIVE_DERIVATIVE, "direction");
  refuses(pindrive_stepper_write(along, bytes, size), PINDRIVE_DERIVATIVE, "is written");
  refuses(pindrive_stepper_write(copy, bytes, size - 1), PINDRIVE_BAD_VALUE, "size must be");
  refuses(pindrive_stepper_evaluate(copy, 9, &x), PINDRIVE_BAD_VALUE, "from 0 to 8, not 9");
  refuses(pindrive_stepper_new(drive, release, NAN, &read), PINDRIVE_BAD_VALUE, "begin must be");
  pindrive_stepper_free(read);
  bytes[size / 2] ^= 1;
  refuses(pindrive_stepper_read(bytes, size, &read), PINDRIVE_BAD_VALUE, "must be those of");
  refuses(pindrive_stepper_read(bytes, 3, &read), PINDRIVE_BAD_VALUE, "must be those of");
  free(bytes);
  pindrive_stepper_free(stepper);
  pindrive_stepper_free(copy);
  pindrive_stepper_free(along);
  pindrive_stepper_free(other);
  pindrive_motion_free(motion);
  pindrive_motion_free(derivative);
  pindrive_drive_free(drive);
  pindrive_drive_free(rate);
  pindrive_release_free(release);
  pindrive_release_free(still);
}

/* A force keeps the pin at a rigid stop, then throws it to the other one. */
/* What a load of the plate that is zero does to the plate's force, of which friction at the speed comes. */
static void along_no_load(void) {
  const double speeds[2] = {0, 0.2}, forces[2] = {0.02, 0.06}, little = 1e-3;
  pindrive_drive *drive = the_drive(), *rate = pindrive_drive_rate_new(drive);
  pindrive_release *release = the_release(), *still;
  pindrive_stepper *stepper = NULL, *along = NULL;
  double force = NAN, slope = NAN;
  pindrive_drive_set_curve(drive, "plate", speeds, forces, 2);
  pindrive_drive_free(rate);
  rate = pindrive_drive_rate_new(drive);
  pindrive_release_set(release, "velocity", 0.05);
  pindrive_release_set(release, "plate_load", 0);
  still = pindrive_release_rate_new(release);
  expect(pindrive_stepper_differentiate(drive, release, rate, still, 0, &along) == PINDRIVE_OK,
         "derivatives at no load");
  expect(pindrive_stepper_set_along(along, "plate_load", 1, 0) == PINDRIVE_OK, "along it");
  expect(pindrive_stepper_evaluate(along, PINDRIVE_PLATE_FORCE, &slope) == PINDRIVE_OK, "a slope");
  pindrive_release_set(release, "plate_load", little);
  expect(pindrive_stepper_new(drive, release, 0, &stepper) == PINDRIVE_OK, "at a little load");
  expect(pindrive_stepper_evaluate(stepper, PINDRIVE_PLATE_FORCE, &force) == PINDRIVE_OK, "force");
  expect(fabs(slope - force / little) < 1e-12, "it is that of a difference");
  expect(fabs(slope - 0.03) < 1e-15, "and friction at the sliding speed");
  pindrive_stepper_free(stepper);
  pindrive_stepper_free(along);
  pindrive_drive_free(rate);
  pindrive_drive_free(drive);
  pindrive_release_free(still);
  pindrive_release_free(release);
}

static void at_stops(void) {
  pindrive_drive *drive = the_drive();
  pindrive_release *release = pindrive_release_new();
  pindrive_stepper *stepper = NULL, *read = NULL;
  pindrive_instant now;
  double push = NAN, x = NAN;
  pindrive_drive_set(drive, "travel", 1e-3);
  pindrive_release_set(release, "displacement", 2e-3);
  refuses(pindrive_stepper_new(drive, release, 0, &stepper), PINDRIVE_BAD_VALUE,
          "displacement must be at most travel");
  pindrive_release_set(release, "displacement", 0);
  pindrive_release_set(release, "mouse_velocity", 0);
  pindrive_release_set(release, "force", 0.5);
  expect(pindrive_stepper_new(drive, release, 0, &stepper) == PINDRIVE_OK, "a stepper with stops");
  do {
    expect(pindrive_stepper_step(stepper, 1, 1, NULL, NULL) == PINDRIVE_OK, "to the next event");
    pindrive_stepper_now(stepper, &now);
  } while (now.time < 1 && now.stop_event == PINDRIVE_NONE);
  expect(now.stop == 1 && now.stop_event == PINDRIVE_STICKS && now.time < 0.1, "it strikes");
  expect(pindrive_stepper_evaluate(stepper, PINDRIVE_STOP_FORCE, &push) == PINDRIVE_OK, "push");
  expect(push < -0.3, "which the stop takes");
  {
    const size_t size = pindrive_stepper_size(stepper);
    unsigned char *bytes = malloc(size);
    expect(pindrive_stepper_write(stepper, bytes, size) == PINDRIVE_OK, "written at a stop");
    expect(pindrive_stepper_read(bytes, size, &read) == PINDRIVE_OK, "read");
    free(bytes);
  }
  pindrive_stepper_now(read, &now);
  expect(now.stop == 1 && now.stop_event == PINDRIVE_STICKS, "as it was");
  pindrive_stepper_set(stepper, "force", -0.5, 0);
  pindrive_stepper_set(read, "force", -0.5, 0);
  x = position_after(stepper, 0.3, 1e-3);
  expect(x == -1e-3 && position_after(read, 0.3, 7e-4) == x, "from one stop to the other");
  pindrive_stepper_free(stepper);
  pindrive_stepper_free(read);
  pindrive_drive_free(drive);
  pindrive_release_free(release);
}

/* Under a constant transverse velocity a step takes no longer the longer it is. */
static void slipping_across(void) {
  const double across[2] = {0.05, 1e12};
  for (int i = 0; i < 2; ++i) {
    pindrive_drive *drive = the_drive();
    pindrive_release *release = the_release();
    pindrive_stepper *stepper = NULL;
    double x = NAN;
    pindrive_release_set(release, "across_velocity", across[i]);
    expect(pindrive_stepper_new(drive, release, 0, &stepper) == PINDRIVE_OK, "a stepper across");
    expect(pindrive_stepper_step(stepper, 1e6, 0, NULL, NULL) == PINDRIVE_OK, "a step of 1e6 s");
    expect(pindrive_stepper_evaluate(stepper, PINDRIVE_POSITION, &x) == PINDRIVE_OK, "position");
    expect(fabs(x) < 1.5e-3, "it slips across");
    refuses(pindrive_stepper_set(stepper, "across_velocity", 1e300, 0), PINDRIVE_BAD_VALUE,
            "across_velocity must be from -1e12 to 1e12");
    pindrive_stepper_free(stepper);
    pindrive_drive_free(drive);
    pindrive_release_free(release);
  }
}

/* A device whose one pin stands on a black line, under a hand at an even speed. */
static pindrive_device *the_device(void) {
  pindrive_device *device = pindrive_device_new();
  expect(pindrive_device_set(device, "drive.mass", 0.010) == PINDRIVE_OK, "mass by its key");
  expect(pindrive_device_set(device, "drive.stiffness", 100) == PINDRIVE_OK, "stiffness");
  expect(pindrive_device_set(device, "drive.damping", 0.4) == PINDRIVE_OK, "damping");
  expect(pindrive_device_set(device, "plate.kinetic", 0.02) == PINDRIVE_OK, "plate");
  expect(pindrive_device_set(device, "finger.kinetic", 0.005) == PINDRIVE_OK, "finger");
  return device;
}

/* Lines of a page under a hand, and the speed at which two lines merge. */
static void lines_and_speeds(void) {
  double paper[400];
  pindrive_piece pieces[2];
  pindrive_term terms[4];
  pindrive_device *device = the_device();
  pindrive_scan *scan = NULL;
  pindrive_line lines[8];
  pindrive_speed_limit limit;
  size_t count = 0;
  for (int i = 0; i < 400; ++i) paper[i] = (i >= 100 && i < 120) || (i >= 200 && i < 220) ? 0 : 1;
  expect(pindrive_device_set(device, "criteria.felt", 40e-6) == PINDRIVE_OK, "a criterion");
  expect(pindrive_scan_new(device, 0, 0, 5e-5, 0.06, 0, 1, &scan) == PINDRIVE_OK, "a scan");
  expect(pindrive_scan_set_page(scan, paper, 1, 400, 1e-4, 0, 0) == PINDRIVE_OK, "a page");
  refuses(pindrive_scan_lines(scan, NULL, NULL, lines, 8, &count), PINDRIVE_BAD_VALUE,
          "two rows of the hand or more");
  expect(pindrive_scan_move(scan, 0.6, 0.06, 0, 1) == PINDRIVE_OK, "the hand moves");
  expect(pindrive_scan_lines(scan, NULL, NULL, lines, 1, &count) == PINDRIVE_MORE &&
             count >= 2,
         "two lines");
  expect(pindrive_scan_lines(scan, NULL, NULL, lines, 8, &count) == PINDRIVE_OK &&
             lines[0].outcome == PINDRIVE_SHOWN && lines[1].outcome == PINDRIVE_SHOWN,
         "that are shown");
  for (size_t i = 2; i < count; ++i)
    expect(lines[i].outcome == PINDRIVE_FALSE && lines[i].height > 0, "before false ones");
  expect(pindrive_scan_load(scan, 0, pieces, terms, 2, &count) == PINDRIVE_MORE && count > 4,
         "pieces of the load");
  expect(pieces[0].polynomial[0] == 1 && pieces[0].count == 0, "that begin with the magnet off");
  expect(pieces[1].count == 2 && pieces[1].terms == terms + 2 && terms[2].decay > 0,
         "and go on by exponentials");
  refuses(pindrive_scan_load(scan, 1, pieces, terms, 2, &count), PINDRIVE_BAD_VALUE,
          "a pin must be from 0 to 0, not 1");
  expect(fabs(lines[0].begin.x - 0.01) < 1e-4 && lines[0].begin.lag > 0, "where they are printed");
  expect(pindrive_scan_advance(scan, 0.1, NULL, NULL) == PINDRIVE_OK, "advanced");
  refuses(pindrive_scan_lines(scan, NULL, NULL, lines, 8, &count), PINDRIVE_BAD_VALUE,
          "not be advanced yet");
  refuses(pindrive_device_speed_limit(device, 4e-3, 4e-3, 0.01, 1, NULL, NULL, &limit),
          PINDRIVE_BAD_VALUE, "width must be from 1e-07 to below the pitch");
  refuses(pindrive_device_speed_limit(device, 4e-3, 2e-3, 1, 1, NULL, NULL, &limit),
          PINDRIVE_BAD_VALUE, "fastest must be above the slowest");
  expect(pindrive_device_speed_limit(device, 4e-3, 2e-3, 0.01, 1, NULL, NULL, &limit) ==
                 PINDRIVE_OK &&
             limit.bands > 0 && limit.distinct_to > 0.05 && limit.distinct_to < 1,
         "a speed at which two lines merge");
  pindrive_scan_free(scan);
  pindrive_device_free(device);
}

static void a_device(void) {
  const double black[2] = {0, 0}, gray[1] = {1.5}, x[2] = {0, 5e-3}, y[2] = {0, 0};
  const double times[2] = {0, 0.01}, volts[2] = {5, 2};
  pindrive_device *device = the_device();
  pindrive_scan *scan = NULL, *copy = NULL, *read = NULL;
  pindrive_scan_instant now;
  pindrive_instant pin;
  pindrive_pin_event events[2];
  double values[2];
  size_t count, size;
  unsigned char *bytes;
  expect(pindrive_device_set_pins(device, x, y, 2) == PINDRIVE_OK, "pins");
  expect(pindrive_scan_new(device, 0.1, 0, 0, 0.06, 0, 1, &scan) == PINDRIVE_OK, "a scan");
  expect(pindrive_scan_now(scan, &now) == PINDRIVE_OK && now.pins == 2 && now.x == 0, "it begins");
  refuses(pindrive_scan_evaluate(scan, PINDRIVE_PULL, values), PINDRIVE_BAD_VALUE, "a second row");
  refuses(pindrive_scan_pin(scan, 0, &pin), PINDRIVE_BAD_VALUE, "a second row");
  refuses(pindrive_scan_advance(scan, 0.2, NULL, NULL), PINDRIVE_BAD_VALUE,
          "to the last row of the hand, 0.1");
  expect(pindrive_scan_copy(scan, &copy) == PINDRIVE_OK, "a copy before the second row");
  refuses(pindrive_scan_move(scan, 0.1, 0, 0, 1), PINDRIVE_BAD_VALUE, "must be later than");
  refuses(pindrive_scan_move(scan, 0.2, NAN, 0, 1), PINDRIVE_BAD_VALUE, "vx must be from -1e12");
  refuses(pindrive_scan_move(scan, 0.2, 0, 0, -1), PINDRIVE_BAD_VALUE, "finger_load must be from 0");
  expect(pindrive_scan_set_page(scan, black, 1, 2, 4e-3, -4e-3, -2e-3) == PINDRIVE_OK, "a page");
  refuses(pindrive_scan_set_page(scan, gray, 1, 1, 1e-4, 0, 0), PINDRIVE_BAD_VALUE,
          "luminance must be from 0 to 1, not 1.5 at pixel 0");
  refuses(pindrive_scan_set_page(scan, black, 0, 2, 1e-4, 0, 0), PINDRIVE_BAD_VALUE, "pixels");
  refuses(pindrive_scan_set_page(scan, black, 1, 2, 0, 0, 0), PINDRIVE_BAD_VALUE, "pixel must be");
  expect(pindrive_scan_move(scan, 0.2, 0.06, 0, 1) == PINDRIVE_OK, "the hand moves");
  expect(pindrive_scan_advance(scan, 0.12, NULL, NULL) == PINDRIVE_OK, "advanced");
  expect(pindrive_scan_now(scan, &now) == PINDRIVE_OK && fabs(now.x - 1.2e-3) < 1e-15, "its place");
  expect(pindrive_scan_evaluate(scan, PINDRIVE_COMMAND, values) == PINDRIVE_OK, "commands");
  expect(values[0] == 1 && values[1] == 0, "of which the pin on the line has one");
  expect(pindrive_scan_evaluate(scan, PINDRIVE_LUMINANCE, values) == PINDRIVE_OK && values[0] == 0,
         "luminance");
  refuses(pindrive_scan_evaluate(scan, 14, values), PINDRIVE_BAD_VALUE, "from 0 to 13, not 14");
  expect(pindrive_scan_pin(scan, 0, &pin) == PINDRIVE_OK && pin.plate == PINDRIVE_STICK &&
             fabs(pin.time - 0.12) < 1e-15,
         "it is carried");
  refuses(pindrive_scan_pin(scan, 2, &pin), PINDRIVE_BAD_VALUE, "from 0 to 1, not 2");
  expect(pindrive_scan_events(scan, NULL, 0, &count) == PINDRIVE_MORE && count == 0, "events");
  expect(pindrive_scan_events(scan, events, 2, &count) == PINDRIVE_OK && count == 1, "one of them");
  expect(events[0].pin == 0 && events[0].event.plate == PINDRIVE_STICKS, "the magnet clamps");
  expect(pindrive_scan_events(scan, events, 2, &count) == PINDRIVE_OK && count == 0, "handed over");

  size = pindrive_scan_size(scan);
  bytes = malloc(size);
  refuses(pindrive_scan_write(scan, bytes, size - 1), PINDRIVE_BAD_VALUE, "size must be");
  expect(pindrive_scan_write(scan, bytes, size) == PINDRIVE_OK, "written");
  expect(pindrive_scan_read(device, bytes, size, &read) == PINDRIVE_OK, "read");
  expect(pindrive_scan_set_page(read, black, 1, 2, 4e-3, -4e-3, -2e-3) == PINDRIVE_OK, "its page");
  expect(pindrive_scan_advance(scan, 0.2, NULL, NULL) == PINDRIVE_OK, "to the end");
  expect(pindrive_scan_advance(read, 0.2, NULL, NULL) == PINDRIVE_OK, "of both");
  {
    double one[2], other[2];
    pindrive_scan_evaluate(scan, PINDRIVE_POSITION, one);
    pindrive_scan_evaluate(read, PINDRIVE_POSITION, other);
    expect(one[0] == other[0] && one[1] == other[1] && fabs(one[0]) > 1e-4, "to the same bits");
  }
  bytes[size / 2] ^= 1;
  pindrive_scan_free(read);
  refuses(pindrive_scan_read(device, bytes, size, &read), PINDRIVE_BAD_VALUE, "of a scan of 2 pins");
  bytes[size / 2] ^= 1;
  expect(pindrive_device_set_pins(device, x, y, 1) == PINDRIVE_OK, "another device");
  refuses(pindrive_scan_read(device, bytes, size, &read), PINDRIVE_BAD_VALUE, "of a scan of 1 pin");
  free(bytes);
  pindrive_scan_free(scan);
  pindrive_scan_free(copy);

  refuses(pindrive_device_set(device, "drive.mas", 1), PINDRIVE_BAD_NAME, "has no number drive.mas");
  refuses(pindrive_device_set_rows(device, "drive.mass", x, y, 1), PINDRIVE_BAD_NAME, "has no rows");
  refuses(pindrive_device_set_pins(device, x, y, 0), PINDRIVE_BAD_VALUE, "at least one pin");
  pindrive_device_set(device, "control.hysteresis", 1.5);
  refuses(pindrive_scan_new(device, 0, 0, 0, 0, 0, 1, &scan), PINDRIVE_BAD_VALUE,
          "control.hysteresis must be");
  pindrive_device_set(device, "control.hysteresis", 0.1);
  expect(pindrive_device_set_rows(device, "magnet.voltage", times, volts, 2) == PINDRIVE_OK, "rows");
  pindrive_device_set(device, "magnet.turns", 250);
  refuses(pindrive_scan_new(device, 0, 0, 0, 0, 0, 1, &scan), PINDRIVE_BAD_VALUE,
          "magnet.turns must be given with pole_area");
  pindrive_device_free(device);
}

/* A stepper follows inputs given over time, and a friction law, also from its bytes. */
static void stepped_functions(void) {
  const pindrive_term wave = {0, 0.1, 0, 75}, along = {0, 1, 0, 0};
  const pindrive_piece hand[] = {{0, {0.02}, &wave, 1}, {0.04, {0.02 + 0.1 * sin(3.0), 1}, NULL, 0}};
  const pindrive_piece rate[] = {{0, {0}, &along, 1}, {0, {sin(3.0)}, NULL, 0}};
  const double times[] = {0, 0.02, 0.05}, forces[] = {0, 0.05, -0.05}, t = 0.06;
  pindrive_drive *drive = the_drive(), *still;
  pindrive_release *release = the_release(), *direction;
  pindrive_stepper *stepper = NULL, *again = NULL, *derivative = NULL, *along_force = NULL;
  pindrive_motion *motion, *differentiated = NULL;
  pindrive_instant now;
  double expected, slope, x;
  size_t size;
  void *bytes;
  pindrive_drive_set(drive, "plate.law", PINDRIVE_LAW_STRIBECK);
  pindrive_drive_set(drive, "plate.breakaway", 0.03);
  pindrive_drive_set(drive, "plate.static", 0.03);
  pindrive_drive_set(drive, "plate.velocity", 0.05);
  pindrive_release_set(release, "velocity", NAN);
  pindrive_release_set(release, "duration", 0.1);
  expect(pindrive_release_set_function(release, "mouse_velocity", hand, 2) == PINDRIVE_OK &&
             pindrive_release_set_profile(release, "force", times, forces, 3) == PINDRIVE_OK,
         "a hand in two pieces and a force in rows");
  still = pindrive_drive_rate_new(drive);
  direction = pindrive_release_rate_new(release);
  pindrive_release_set_function(direction, "mouse_velocity", rate, 2);
  motion = run(drive, release);
  pindrive_evaluate(motion, PINDRIVE_POSITION, &t, 1, PINDRIVE_RIGHT, &expected);
  expect(pindrive_stepper_new(drive, release, 0, &stepper) == PINDRIVE_OK, "their stepper");
  position_after(stepper, 0.03, 0.004);
  size = pindrive_stepper_size(stepper);
  bytes = malloc(size);
  expect(pindrive_stepper_write(stepper, bytes, size) == PINDRIVE_OK &&
             pindrive_stepper_read(bytes, size, &again) == PINDRIVE_OK,
         "written and read");
  x = position_after(stepper, t, 0.007);
  expect(fabs(x - expected) < 1e-15, "it is where the motion is");
  expect(position_after(again, t, 0.011) == x, "so it is from its bytes");
  expect(pindrive_stepper_now(stepper, &now) == PINDRIVE_OK && fabs(now.mouse_velocity_rate - 1) < 1e-12,
         "the hand is in its second piece");
  refuses(pindrive_stepper_set(stepper, "force", 0, 0), PINDRIVE_UNSUPPORTED, "force cannot be set");
  expect(pindrive_stepper_set(stepper, "plate_load", 1.5, 0) == PINDRIVE_OK, "another input can");
  expect(pindrive_differentiate(drive, release, still, direction, NULL, NULL, &differentiated) ==
                 PINDRIVE_OK &&
             pindrive_stepper_differentiate(drive, release, still, direction, 0, &derivative) ==
                 PINDRIVE_OK,
         "derivatives by the amplitude of the hand");
  pindrive_evaluate(differentiated, PINDRIVE_POSITION, &t, 1, PINDRIVE_RIGHT, &slope);
  expect(fabs(position_after(derivative, t, 0.007) - slope) < 1e-12 * fabs(slope), "are those of the motion");
  expect(pindrive_stepper_derivative(again, &along_force) == PINDRIVE_OK &&
             pindrive_stepper_evaluate(along_force, PINDRIVE_ACCELERATION, &x) == PINDRIVE_OK && x == 0,
         "nothing changes along no direction, under a law too");
  free(bytes);
  pindrive_motion_free(motion);
  pindrive_motion_free(differentiated);
  pindrive_stepper_free(stepper);
  pindrive_stepper_free(again);
  pindrive_stepper_free(derivative);
  pindrive_stepper_free(along_force);
  pindrive_drive_free(drive);
  pindrive_drive_free(still);
  pindrive_release_free(release);
  pindrive_release_free(direction);
}

/* Functions by their names, and sums: a constant and two functions are one function. */
static void named_functions(void) {
  const double wave[] = {0, 0.01, 8, 0.3}, stroke[] = {0.02, 0.4, 0.1}, backwards[] = {0.02, -0.4, 0.1};
  const double fast[] = {0, 1, 1e8, 0};
  pindrive_drive *drive = the_drive();
  pindrive_release *release = the_release();
  pindrive_piece pieces[3];
  pindrive_term terms[3];
  pindrive_stepper *stepper = NULL;
  pindrive_instant now;
  size_t count = 0;
  const double t = 0.25, s = 0.375;
  double expected = 0.06 + 0.01 * sin(2 * 3.141592653589793 * 8 * 0.25 + 0.3);
  pindrive_release_set(release, "velocity", NAN);
  pindrive_release_set(release, "duration", 1);
  pindrive_release_set(release, "mouse_velocity", 0.06);
  expect(pindrive_function("harmonic", wave, 4, pieces, terms, &count) == PINDRIVE_OK && count == 1,
         "a sinusoid by its name");
  expect(pieces[0].terms == terms && pieces[0].count == 1 && terms[0].cosine == 0.01 * sin(0.3), "has a term");
  expect(pindrive_release_add_function(release, "mouse_velocity", pieces, count) == PINDRIVE_OK,
         "added to a constant");
  expect(pindrive_function("minimum_jerk", stroke, 3, pieces, terms, &count) == PINDRIVE_OK && count == 3,
         "a stroke by its name");
  expect(pieces[1].begin == 0.1 && pieces[1].count == 0 && pieces[1].terms == NULL, "has none");
  expect(pindrive_release_add_function(release, "mouse_velocity", pieces, count) == PINDRIVE_OK,
         "added to a function");
  expected += 30 * 0.02 / 0.4 * s * s * (1 - s) * (1 - s);
  pindrive_stepper_new(drive, release, 0, &stepper);
  position_after(stepper, t, 0.01);
  expect(pindrive_stepper_now(stepper, &now) == PINDRIVE_OK && fabs(now.mouse_velocity - expected) < 1e-15,
         "the sum is the hand's velocity");
  refuses(pindrive_function("sine", wave, 4, pieces, terms, &count), PINDRIVE_BAD_NAME, "minimum_jerk");
  refuses(pindrive_function("harmonic", wave, 3, pieces, terms, &count), PINDRIVE_BAD_VALUE,
          "must have 4 numbers, not 3");
  refuses(pindrive_function("harmonic", fast, 4, pieces, terms, &count), PINDRIVE_BAD_VALUE,
          "a rate of harmonic must be");
  refuses(pindrive_function("minimum_jerk", backwards, 3, pieces, terms, &count), PINDRIVE_BAD_VALUE,
          "of minimum_jerk must begin after");
  refuses(pindrive_release_add_function(release, "speed", pieces, 1), PINDRIVE_BAD_NAME, "the inputs");
  pindrive_stepper_free(stepper);
  pindrive_drive_free(drive);
  pindrive_release_free(release);
}

/* Inputs as functions of time: a sinusoid has a periodic response. */
static void functions(void) {
  const pindrive_term wave = {0, 0.1, 0, 75}, along = {0, 1, 0, 0}, fast = {0, 1, 0, 1e8};
  const pindrive_term deep = {1.5, 0, 0, 75}, grows = {0, 0.1, 0, 40.0 * sqrt(2)};
  const pindrive_piece hand = {0, {0.02}, &wave, 1}, rate = {0, {0}, &along, 1};
  const pindrive_piece load = {0, {1}, &deep, 1}, too_fast = {0, {0}, &fast, 1};
  const pindrive_piece other = {0, {0}, &grows, 1};
  const pindrive_piece jumps[] = {{0, {0.02}, NULL, 0}, {0.1, {0.05}, NULL, 0}};
  const pindrive_piece overlap[] = {{0.1, {0.02}, NULL, 0}, {0.1, {0.02}, NULL, 0}};
  pindrive_drive *drive = the_drive();
  pindrive_release *release = the_release(), *more = the_release(), *direction, *bad = the_release();
  pindrive_drive *still = pindrive_drive_rate_new(drive);
  pindrive_motion *motion, *derivative = NULL, *greater;
  pindrive_outcome outcome;
  const double t = 0.05, h = 1e-7;
  pindrive_term wider = wave;
  pindrive_piece hand_after = hand;
  double x, y, slope;
  expect(pindrive_release_set_function(release, "mouse_velocity", &hand, 1) == PINDRIVE_OK,
         "a sinusoid");
  motion = run(drive, release);
  expect(pindrive_outcome_of(motion, &outcome) == PINDRIVE_OK &&
             outcome.end == PINDRIVE_END_DRIVEN && fabs(outcome.period * 75 / 6.283185307179586 - 1) < 1e-12,
         "its response repeats with it");
  direction = pindrive_release_rate_new(release);
  pindrive_release_set_function(direction, "mouse_velocity", &rate, 1);
  expect(pindrive_differentiate(drive, release, still, direction, NULL, NULL, &derivative) ==
             PINDRIVE_OK,
         "the derivative by its amplitude");
  wider.sine += h;
  hand_after.terms = &wider;
  pindrive_release_set_function(more, "mouse_velocity", &hand_after, 1);
  greater = run(drive, more);
  pindrive_evaluate(motion, PINDRIVE_POSITION, &t, 1, PINDRIVE_RIGHT, &x);
  pindrive_evaluate(greater, PINDRIVE_POSITION, &t, 1, PINDRIVE_RIGHT, &y);
  pindrive_evaluate(derivative, PINDRIVE_POSITION, &t, 1, PINDRIVE_RIGHT, &slope);
  expect(fabs((y - x) / h - slope) < 1e-4 * fabs(slope) + 1e-9, "is that of the difference");
  refuses(pindrive_release_set_function(bad, "velocity", &hand, 1), PINDRIVE_BAD_NAME, "the inputs");
  refuses(pindrive_release_set_function(bad, "force", &hand, 0), PINDRIVE_BAD_VALUE, "at least one piece");
  pindrive_release_set_function(bad, "mouse_velocity", jumps, 2);
  refuses(pindrive_simulate(drive, bad, NULL, NULL, &motion), PINDRIVE_BAD_VALUE, "without a jump");
  pindrive_release_set_function(bad, "mouse_velocity", overlap, 2);
  refuses(pindrive_simulate(drive, bad, NULL, NULL, &motion), PINDRIVE_BAD_VALUE, "begin after");
  pindrive_release_set_function(bad, "mouse_velocity", &too_fast, 1);
  refuses(pindrive_simulate(drive, bad, NULL, NULL, &motion), PINDRIVE_BAD_VALUE, "a rate of mouse_velocity");
  pindrive_release_set_function(bad, "mouse_velocity", &hand, 1);
  pindrive_release_set_function(bad, "force", &other, 1);
  refuses(pindrive_simulate(drive, bad, NULL, NULL, &motion), PINDRIVE_BAD_VALUE, "neither end nor repeat");
  pindrive_release_set(bad, "force", 0);
  pindrive_release_set_function(bad, "plate_load", &load, 1);
  refuses(pindrive_simulate(drive, bad, NULL, NULL, &motion), PINDRIVE_BAD_VALUE, "must not be negative");
  pindrive_release_set(bad, "plate_load", 1);
  pindrive_motion_free(motion);
  pindrive_motion_free(derivative);
  pindrive_motion_free(greater);
  pindrive_drive_free(drive);
  pindrive_drive_free(still);
  pindrive_release_free(release);
  pindrive_release_free(more);
  pindrive_release_free(direction);
  pindrive_release_free(bad);
}

int main(void) {
  expect(pindrive_interface() == PINDRIVE_INTERFACE, "the header is that of the library");
  a_motion();
  derivatives();
  mistakes();
  functions();
  named_functions();
  stepped_functions();
  stopping();
  a_batch();
  stepping();
  along_no_load();
  at_stops();
  slipping_across();
  a_device();
  lines_and_speeds();
  pindrive_motion_free(NULL);
  pindrive_drive_free(NULL);
  pindrive_release_free(NULL);
  pindrive_stepper_free(NULL);
  pindrive_device_free(NULL);
  pindrive_scan_free(NULL);
  printf("%d failures\n", failures);
  return failures == 0 ? 0 : 1;
}
