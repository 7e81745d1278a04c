/* Processor time of a device under a hand that is given as it moves: sixteen pins over gratings, one row of the
 * hand and one evaluation for each millisecond. Built and run by benchmarks/scans.py. */
#define _POSIX_C_SOURCE 199309L
#include <math.h>
#include <pindrive.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { pins = 16, columns = 1200, rows = 300, steps = 1500 };

static double now(void) {
  struct timespec time;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static int ascending(const void *one, const void *other) {
  const double a = *(const double *)one, b = *(const double *)other;
  return (a > b) - (a < b);
}

static void check(pindrive_error error) {
  if (error == PINDRIVE_OK || error == PINDRIVE_MORE) return;
  fprintf(stderr, "%s\n", pindrive_last_error());
  exit(1);
}

/* The reader of examples/tactile-reader.toml. */
static pindrive_device *reader(double skin) {
  static const struct {
    const char *key;
    double value;
  } numbers[] = {{"drive.mass", 1e-3},          {"drive.stiffness", 250},
                 {"drive.damping_ratio", 0.5},  {"plate.coefficient", 0.225},
                 {"plate.static_coefficient", 0.27}, {"finger.touch_force", 0.06},
                 {"finger.coefficient", 0.5},   {"finger.static_coefficient", 0.75}};
  double x[pins], y[pins];
  pindrive_device *device = pindrive_device_new();
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; ++i)
    check(pindrive_device_set(device, numbers[i].key, numbers[i].value));
  if (skin > 0) check(pindrive_device_set(device, "finger.stiffness", skin));
  for (int i = 0; i < pins; ++i) {
    x[i] = 5e-3 * (i % 4);
    y[i] = 5e-3 * (i / 4);
  }
  check(pindrive_device_set_pins(device, x, y, pins));
  return device;
}

static void run(const char *name, double skin, double shaking, double across) {
  static double luminance[columns * rows], times[steps];
  double values[pins], sum = 0;
  pindrive_pin_event events[256];
  size_t count, all = 0;
  pindrive_device *device = reader(skin);
  pindrive_scan *scan = NULL;
  for (int i = 0; i < columns * rows; ++i) luminance[i] = i % columns % 40 < 15 ? 0 : 1;
  check(pindrive_scan_new(device, 0, 2e-3, 2e-3, 0.06, 0, 1, &scan));
  check(pindrive_scan_set_page(scan, luminance, rows, columns, 1e-4, 0, 0));
  for (int i = 0; i < steps; ++i) {
    const double t = 1e-3 * (i + 1), begin = now();
    check(pindrive_scan_move(scan, t, 0.06 * (1 + shaking * sin(50 * t)), across * sin(30 * t), 1));
    check(pindrive_scan_advance(scan, t, NULL, NULL));
    check(pindrive_scan_evaluate(scan, PINDRIVE_POSITION, values));
    times[i] = now() - begin;
    sum += times[i];
    do {
      check(pindrive_scan_events(scan, events, 256, &count));
      all += count;
    } while (count == 256);
  }
  qsort(times, steps, sizeof *times, ascending);
  printf("%-34s mean %6.1f, median %6.1f, 99 %% %6.1f us; %zu events\n", name, 1e6 * sum / steps,
         1e6 * times[steps / 2], 1e6 * times[steps * 99 / 100], all);
  pindrive_scan_free(scan);
  pindrive_device_free(device);
}

int main(void) {
  run("rigid finger, even hand", 0, 0, 0);
  run("rigid finger, shaking hand", 0, 0.5, 0);
  run("elastic skin, even hand", 300, 0, 0);
  run("elastic skin, shaking hand", 300, 0.5, 0);
  run("elastic skin, oblique shaking hand", 300, 0.5, 5e-3);
  return 0;
}
