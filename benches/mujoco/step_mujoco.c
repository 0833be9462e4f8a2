// Steps an exported model in MuJoCo with recorded commands: times mj_step alone, or prints the arm's joint angles.
//
//   step_mujoco MODEL.xml PHASE.txt time|trace STEPS_PER_10_MS SECONDS
//   step_mujoco MODEL.xml - drive STEPS_PER_10_MS 0
//
// `drive` takes phases from the standard input, one after the other, their commands one by one: each after a line that
// tells the state and the contacts.
//
// The muscles' law is farsa-body/src/actuators/muscle.rs: torque without its damping part in qfrc_applied; damping, and stiffness
// times the step, in dof_damping, which MuJoCo integrates implicitly. Both are computed before every mj_step and are not
// in the time.

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <mujoco/mujoco.h>

enum { MUSCLES = 7, JOINTS = 27, WORDS = 14 + 20, MOST = 10000, SETTLED = 20 };

typedef struct {
  double tension, arm, lower, upper, shortest, rest, longest, shape, scale, viscosity;
} Muscle;

static Muscle muscles[MUSCLES];
static double start_q[JOINTS], start_v[JOINTS], sphere[13];
static double commands[MOST][WORDS];
// Other programs interrupt: the least of a control step's repetitions is its own time.
static double least[MOST];
static int contacts, steps;
static int qadr[JOINTS], vadr[JOINTS], sphere_q, sphere_v, palm, ball;
static double damping[MUSCLES];

static double number(FILE* file) {
  double x;
  if (fscanf(file, "%lf", &x) != 1) {
    fprintf(stderr, "the phase ends too early\n");
    exit(1);
  }
  return x;
}

// Where a phase begins and how many commands it has.
static void read_start(FILE* file) {
  for (int i = 0; i < MUSCLES; i++) {
    double* word = &muscles[i].tension;
    for (int k = 0; k < 10; k++) word[k] = number(file);
  }
  for (int i = 0; i < JOINTS; i++) start_q[i] = number(file);
  for (int i = 0; i < JOINTS; i++) start_v[i] = number(file);
  for (int i = 0; i < 13; i++) sphere[i] = number(file);
  contacts = (int)number(file);
  steps = (int)number(file);
}

static void read_phase(const char* name) {
  FILE* file = fopen(name, "r");
  if (!file) {
    perror(name);
    exit(1);
  }
  read_start(file);
  if (steps > MOST) exit(1);
  for (int t = 0; t < steps; t++)
    for (int i = 0; i < WORDS; i++) commands[t][i] = number(file);
  fclose(file);
}

// Active and passive tension and their slope by the length.
static double elastic(const Muscle* m, double length, double activation, double* slope) {
  double per = 1 / (m->longest - m->rest);
  double e = (length - m->rest) * per;
  double pull = activation * m->tension;
  double parabola = 1 - e * e;
  double growth = m->scale * exp(m->shape * e);
  *slope = ((parabola > 0 ? -2 * pull * e : 0) + growth * m->shape) * per;
  return (parabola > 0 ? pull * parabola : 0) + growth - m->scale;
}

static void pull(const mjModel* m, mjData* d, const double* command) {
  double h = m->opt.timestep;
  for (int i = 0; i < MUSCLES; i++) {
    const Muscle* u = &muscles[i];
    double gear = (u->longest - u->shortest) / (u->upper - u->lower);
    double stroke = gear * (d->qpos[qadr[i]] - u->lower);
    double slope1, slope2;
    double t1 = elastic(u, u->shortest + stroke, command[2 * i], &slope1);
    double t2 = elastic(u, u->longest - stroke, command[2 * i + 1], &slope2);
    double stiffness = fmax(0, u->arm * gear * (slope1 + slope2));
    d->qfrc_applied[vadr[i]] = u->arm * (t2 - t1);
    m->dof_damping[vadr[i]] = damping[i] + 2 * u->arm * gear * u->viscosity + h * stiffness;
  }
}

static void place(const mjModel* m, mjData* d) {
  mj_resetData(m, d);
  for (int i = 0; i < JOINTS; i++) {
    d->qpos[qadr[i]] = start_q[i];
    d->qvel[vadr[i]] = start_v[i];
  }
  mju_copy(d->qpos + sphere_q, sphere, 7);
  mju_copy(d->qvel + sphere_v, sphere + 7, 3);
  // Angular velocity is in the body's axes here.
  double back[4];
  mju_negQuat(back, sphere + 3);
  mju_rotVecQuat(d->qvel + sphere_v + 3, sphere + 10, back);
}

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec * 1e6 + t.tv_nsec * 1e-3;
}

// The sphere's centre in the palm's frame.
static void held(const mjModel* m, mjData* d, double* at) {
  mj_kinematics(m, d);
  double away[3];
  mju_sub3(away, d->xpos + 3 * ball, d->xpos + 3 * palm);
  mju_mulMatTVec3(at, d->xmat + 9 * palm, away);
}

// One line: joint angles and speeds, the sphere in the hand and its height, every contact's geoms, depth, normal force.
static void tell(const mjModel* m, mjData* d) {
  double at[3];
  held(m, d, at);
  for (int i = 0; i < JOINTS; i++) printf("%.9g %.9g ", d->qpos[qadr[i]], d->qvel[vadr[i]]);
  printf("%.9g %.9g %.9g %.9g", at[0], at[1], at[2], d->xpos[3 * ball + 2]);
  for (int i = 0; i < d->ncon; i++) {
    const mjContact* c = &d->contact[i];
    double force[6];
    mj_contactForce(m, d, i, force);
    const char* names[2];
    for (int k = 0; k < 2; k++) names[k] = mj_id2name(m, mjOBJ_GEOM, c->geom[k]);
    printf(" %s %s %.9g %.9g", names[0], names[1], -c->dist, force[0]);
  }
  printf("\n");
  fflush(stdout);
}

static void drive(const mjModel* m, mjData* d, const int* motor, int substeps) {
  for (;;) {
    int next;
    do next = getchar();
    while (next == ' ' || next == '\n');
    if (next == EOF) return;
    ungetc(next, stdin);
    read_start(stdin);
    place(m, d);
    tell(m, d);
    for (int t = 0; t < steps; t++) {
      double command[WORDS];
      for (int i = 0; i < WORDS; i++) command[i] = number(stdin);
      for (int i = MUSCLES; i < JOINTS; i++) d->ctrl[motor[i]] = command[14 + i - MUSCLES];
      for (int k = 0; k < substeps; k++) {
        pull(m, d, command);
        mj_step(m, d);
      }
      tell(m, d);
    }
  }
}

int main(int argc, char** argv) {
  if (argc != 6) return 2;
  char error[1000] = "";
  mjModel* m = mj_loadXML(argv[1], NULL, error, sizeof error);
  if (!m) {
    fprintf(stderr, "%s\n", error);
    return 1;
  }
  int driven = !strcmp(argv[3], "drive"), trace = !strcmp(argv[3], "trace");
  if (!driven) read_phase(argv[2]);
  int substeps = atoi(argv[4]);
  double seconds = atof(argv[5]);
  m->opt.timestep = 0.01 / substeps;
  // A few per cent faster than implicitfast, and as good here.
  m->opt.integrator = mjINT_EULER;
  if (!driven && !contacts) m->opt.disableflags |= mjDSBL_CONTACT;
  mjData* d = mj_makeData(m);
  int motor[JOINTS];
  for (int i = 0; i < JOINTS; i++) {
    char name[8];
    snprintf(name, sizeof name, "J%d", i + 1);
    int j = mj_name2id(m, mjOBJ_JOINT, name);
    motor[i] = mj_name2id(m, mjOBJ_ACTUATOR, name);
    if (j < 0 || motor[i] < 0) return 1;
    qadr[i] = m->jnt_qposadr[j];
    vadr[i] = m->jnt_dofadr[j];
    if (i < MUSCLES) damping[i] = m->dof_damping[vadr[i]];
  }
  palm = mj_name2id(m, mjOBJ_BODY, "palm");
  ball = mj_name2id(m, mjOBJ_BODY, "sphere");
  sphere_q = m->jnt_qposadr[m->body_jntadr[ball]];
  sphere_v = m->jnt_dofadr[m->body_jntadr[ball]];

  if (driven) {
    drive(m, d, motor, substeps);
    return 0;
  }
  double begin = now(), points = 0, rows = 0, iterations = 0, slip = 0, height = 0;
  long count = 0;
  do {
    place(m, d);
    double first[3], last[3];
    held(m, d, first);
    for (int t = 0; t < steps; t++) {
      for (int i = MUSCLES; i < JOINTS; i++) d->ctrl[motor[i]] = commands[t][14 + i - MUSCLES];
      double spent = 0;
      for (int k = 0; k < substeps; k++) {
        pull(m, d, commands[t]);
        double before = now();
        mj_step(m, d);
        spent += now() - before;
        points += d->ncon;
        rows += d->nefc;
        iterations += d->solver_niter[0];
      }
      if (!count || spent < least[t]) least[t] = spent;
      if (t + 1 == SETTLED) held(m, d, first);
      if (trace) {
        for (int i = 0; i < MUSCLES; i++) printf("%.12g ", d->qpos[qadr[i]] * 180 / mjPI);
        printf("\n");
      }
    }
    held(m, d, last);
    slip = mju_dist3(first, last) * 1e3;
    height = d->xpos[3 * ball + 2] * 1e3;
    count += steps;
  } while (!trace && now() - begin < seconds * 1e6);
  double sum = 0;
  for (int t = 0; t < steps; t++) sum += least[t];
  if (!trace) {
    double n = (double)count * substeps;
    printf("%.4f %.2f %.1f %.2f %.4f %.3f %d\n", sum / steps, points / n, rows / n, iterations / n, slip, height,
           d->warning[mjWARN_BADQACC].number);
  }
  return 0;
}
