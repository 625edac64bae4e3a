/* hbvib_mex.c - every function of hbvib.h from MATLAB and GNU Octave.
 *
 *   [out1, out2, ..., status] = hbvib_mex('NAME', in1, in2, ...)
 *
 * calls hbvib_NAME. Inputs stand in the order of the C arguments, indices count from 0:
 *   number             the value, or a constant of an enumeration by its name without HBVIB_, 'jenkins'
 *   handle             the uint64 that the function which made the object gave
 *   array              any numeric array; [] is NULL. Where C takes complex numbers, real ones are taken, too
 *   struct             a struct with the fields to change from their defaults, an array of them, or [] for NULL
 *   hooks              [], or a struct with `progress`, a function handle: progress(state) is called after each point and
 *                      returns false to stop
 *   array to fill      its number of entries; 0 or [] is NULL. It becomes an output
 * Outputs are what C fills: arrays, counts, handles, structs, and at the end the status, which is positive where the
 * call stopped early. A negative status is an error with the identifier hbvib:E_INDEX and so on, and the library's sentence.
 * Ctrl-C stops every call that takes hooks.
 *
 * The classes hbvib.Model and hbvib.Branch are made of these calls. Everything below the mark is generated.
 */
#include "mex.h"
#include "hbvib.h"
#include <math.h>
#include <signal.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#define MOST_OUTPUTS 24

/* Whether the user has pressed Ctrl-C. */
#ifdef HAVE_OCTAVE
extern sig_atomic_t octave_interrupt_state;
static int interrupted(void) { return octave_interrupt_state > 0; }
#else
extern bool utIsInterruptPending(void); /* of libut, which MATLAB's own functions use */
static int interrupted(void) { return utIsInterruptPending(); }
#endif

typedef struct {
  const char *name;
  int value;
} Constant;

typedef enum { INT32, INT64, DOUBLE, DOUBLES, COMPLEXES, INT64S, STRUCTS } Kind;

struct Struct_;

typedef struct {
  const char *name;
  Kind kind;
  size_t offset;
  size_t count;                 /* of an array within the struct */
  const struct Struct_ *nested; /* what STRUCTS points to */
} Field;

typedef struct Struct_ {
  const char *name;
  size_t size;
  const Field *fields;
  size_t count;
  hbvib_status (*fill)(void *s);
} Struct;

/* One call: inputs that are not yet read, outputs so far. */
typedef struct {
  const char *name;
  int inputs;
  const mxArray **in;
  int read;
  int outputs;
  mxArray *out[MOST_OUTPUTS];
  hbvib_model *model; /* made by this call: freed again where it fails */
  hbvib_branch *branch[2];
  hbvib_batch *batch;
  mxArray *progress;
  mxArray *failure; /* what the function progress threw */
  int stopped;
  hbvib_hooks hooks;
} Call;

typedef struct {
  const char *name;
  void (*call)(Call *a);
  int inputs;
} Function;

/* ---- Inputs ---- */

static void refuse(const Call *a, const char *name, const char *what) {
  mexErrMsgIdAndTxt("hbvib:input", "%s: %s %s", a->name, name, what);
}

static const mxArray *next(Call *a) { return a->in[a->read++]; }

/* The value of a constant by its name in any case, without HBVIB_. */
static int named(const Call *a, const char *name, const mxArray *m);

static double number_of(const Call *a, const char *name, const mxArray *m) {
  if (mxIsChar(m)) return named(a, name, m);
  if ((!mxIsNumeric(m) && !mxIsLogical(m)) || mxIsComplex(m) || mxGetNumberOfElements(m) != 1)
    refuse(a, name, "needs one real number");
  return mxGetScalar(m);
}

/* Whole numbers of a double are exact to 2^53; those of int64 and uint64 arrays are taken as they are. */
static int64_t whole_entry(const Call *a, const char *name, const mxArray *m, mwSize i) {
  double value;
  if (mxIsInt64(m) || mxIsUint64(m)) return ((const int64_t *)mxGetData(m))[i];
  if (mxIsDouble(m)) {
    value = mxGetPr(m)[i];
  } else if (mxIsInt32(m)) {
    value = ((const int32_t *)mxGetData(m))[i];
  } else if (mxIsLogical(m)) {
    value = mxGetLogicals(m)[i];
  } else {
    refuse(a, name, "needs whole numbers of class double, int32, int64 or logical");
    return 0;
  }
  if (!(fabs(value) <= 9007199254740992.0) || value != floor(value)) refuse(a, name, "needs whole numbers");
  return (int64_t)value;
}

static int64_t whole_of(const Call *a, const char *name, const mxArray *m) {
  if (mxIsChar(m)) return named(a, name, m);
  number_of(a, name, m);
  return whole_entry(a, name, m, 0);
}

static int32_t whole32_of(const Call *a, const char *name, const mxArray *m) {
  int64_t value = whole_of(a, name, m);
  if (value != (int32_t)value) refuse(a, name, "does not fit into 32 bits");
  return (int32_t)value;
}

static int64_t whole(Call *a, const char *name) { return whole_of(a, name, next(a)); }
static int32_t whole32(Call *a, const char *name) { return whole32_of(a, name, next(a)); }
static double real(Call *a, const char *name) { return number_of(a, name, next(a)); }

static void *handle(Call *a, const char *name) {
  const mxArray *m = next(a);
  if (mxIsEmpty(m)) return NULL;
  if (!mxIsUint64(m) || mxGetNumberOfElements(m) != 1) refuse(a, name, "needs the uint64 of an object of the library");
  return (void *)(uintptr_t)((const uint64_t *)mxGetData(m))[0];
}

static char *text(Call *a, const char *name) {
  const mxArray *m = next(a);
  if (!mxIsChar(m)) refuse(a, name, "needs text");
  return mxArrayToString(m);
}

static const void *bytes(Call *a, const char *name) {
  const mxArray *m = next(a);
  if (!mxIsUint8(m)) refuse(a, name, "needs bytes of class uint8");
  return mxGetData(m);
}

/* Memory that the host frees after the call. */
static void *array(int64_t n, size_t width) { return n ? mxCalloc((mwSize)n, width) : NULL; }

static int64_t room(Call *a, const char *name) {
  const mxArray *m = next(a);
  int64_t n;
  if (mxIsEmpty(m)) return 0;
  n = whole_of(a, name, m);
  if (n < 0 || n > (int64_t)1 << 40) refuse(a, name, "needs the number of its entries, from 0 to 2^40");
  return n;
}

static const double *reals_of(const Call *a, const char *name, const mxArray *m) {
  mwSize i, n = mxGetNumberOfElements(m);
  double *x;
  if (mxIsEmpty(m)) return NULL;
  if (mxIsComplex(m)) refuse(a, name, "is complex, needs real numbers");
  if (mxIsSparse(m)) refuse(a, name, "is sparse, needs a full array");
  if (mxIsDouble(m)) return mxGetPr(m);
  x = mxMalloc(n * sizeof *x);
  for (i = 0; i < n; i++) x[i] = (double)whole_entry(a, name, m, i);
  return x;
}

static const double *complexes_of(const Call *a, const char *name, const mxArray *m) {
  mwSize i, n = mxGetNumberOfElements(m);
  const double *re, *im;
  double *x;
  if (mxIsEmpty(m)) return NULL;
  if (!mxIsDouble(m) || mxIsSparse(m)) refuse(a, name, "needs a full array of class double");
  x = mxMalloc(2 * n * sizeof *x);
  re = mxGetPr(m);
  im = mxIsComplex(m) ? mxGetPi(m) : NULL;
  for (i = 0; i < n; i++) {
    x[2 * i] = re[i];
    x[2 * i + 1] = im ? im[i] : 0;
  }
  return x;
}

static const int64_t *wholes_of(const Call *a, const char *name, const mxArray *m) {
  mwSize i, n = mxGetNumberOfElements(m);
  int64_t *x;
  if (mxIsEmpty(m)) return NULL;
  if (mxIsComplex(m) || mxIsSparse(m)) refuse(a, name, "needs a full array of whole numbers");
  x = mxMalloc(n * sizeof *x);
  for (i = 0; i < n; i++) x[i] = whole_entry(a, name, m, i);
  return x;
}

static const double *reals(Call *a, const char *name) { return reals_of(a, name, next(a)); }
static const double *complexes(Call *a, const char *name) { return complexes_of(a, name, next(a)); }
static const int64_t *wholes(Call *a, const char *name) { return wholes_of(a, name, next(a)); }

static const int32_t *wholes32(Call *a, const char *name) {
  const mxArray *m = next(a);
  const int64_t *wide = wholes_of(a, name, m);
  mwSize i, n = mxGetNumberOfElements(m);
  int32_t *x;
  if (!wide) return NULL;
  x = mxMalloc(n * sizeof *x);
  for (i = 0; i < n; i++) {
    if (wide[i] != (int32_t)wide[i]) refuse(a, name, "does not fit into 32 bits");
    x[i] = (int32_t)wide[i];
  }
  return x;
}

/* ---- Structs ---- */

static const void *structs_of(const Call *a, const char *name, const mxArray *m, const Struct *of);

static const Field *field(const Struct *of, const char *name) {
  size_t i;
  for (i = 0; i < of->count; i++)
    if (!strcmp(of->fields[i].name, name)) return &of->fields[i];
  return NULL;
}

/* Changes one field; a field NAME_len follows the length of NAME. */
static void set_field(const Call *a, const Struct *of, char *s, const Field *f, const mxArray *m) {
  char *to = s + f->offset, length[64];
  mwSize n = mxGetNumberOfElements(m), i;
  const Field *count;
  if (f->kind <= DOUBLE && f->count > 1) {
    if ((size_t)n != f->count) refuse(a, f->name, "has another number of entries than it needs");
    for (i = 0; i < n; i++) {
      if (f->kind == DOUBLE) ((double *)to)[i] = reals_of(a, f->name, m)[i];
      else if (f->kind == INT64) ((int64_t *)to)[i] = whole_entry(a, f->name, m, i);
      else refuse(a, f->name, "cannot be set");
    }
    return;
  }
  switch (f->kind) {
    case INT32: *(int32_t *)to = whole32_of(a, f->name, m); return;
    case INT64: *(int64_t *)to = whole_of(a, f->name, m); return;
    case DOUBLE: *(double *)to = number_of(a, f->name, m); return;
    case DOUBLES: *(const double **)to = reals_of(a, f->name, m); break;
    case COMPLEXES: *(const double **)to = complexes_of(a, f->name, m); break;
    case INT64S: *(const int64_t **)to = wholes_of(a, f->name, m); break;
    case STRUCTS: *(const void **)to = structs_of(a, f->name, m, f->nested); break;
  }
  snprintf(length, sizeof length, "%s_len", f->name);
  count = field(of, length);
  if (count) *(int64_t *)(s + count->offset) = (int64_t)n;
}

static const void *structs_of(const Call *a, const char *name, const mxArray *m, const Struct *of) {
  mwSize i, n = mxGetNumberOfElements(m);
  int k;
  char *all;
  if (mxIsEmpty(m)) return NULL;
  if (!mxIsStruct(m)) refuse(a, name, "needs a struct");
  all = mxCalloc(n, of->size);
  for (i = 0; i < n; i++) {
    of->fill(all + i * of->size);
    for (k = 0; k < mxGetNumberOfFields(m); k++) {
      const char *key = mxGetFieldNameByNumber(m, k);
      const mxArray *value = mxGetFieldByNumber(m, i, k);
      const Field *known = field(of, key);
      if (!known) {
        char list[1600] = "";
        size_t j, end = 0;
        for (j = 0; j < of->count && end < sizeof list - 80; j++)
          end += (size_t)snprintf(list + end, sizeof list - end, "%s%s", j ? ", " : "", of->fields[j].name);
        mexErrMsgIdAndTxt("hbvib:input", "%s: there is no '%s', needs one of %s", a->name, key, list);
      }
      if (value && !(mxIsEmpty(value) && !mxIsChar(value))) set_field(a, of, all + i * of->size, known, value);
    }
  }
  return all;
}

static const void *structs(Call *a, const char *name, const Struct *of) { return structs_of(a, name, next(a), of); }

/* ---- Outputs ---- */

static void give(Call *a, mxArray *m) {
  if (a->outputs < MOST_OUTPUTS) a->out[a->outputs++] = m;
}

static void give_number(Call *a, double x) { give(a, mxCreateDoubleScalar(x)); }

static void give_text(Call *a, const char *s) { give(a, mxCreateString(s ? s : "")); }

static void give_handle(Call *a, void *object) {
  mxArray *m = mxCreateNumericMatrix(1, 1, mxUINT64_CLASS, mxREAL);
  ((uint64_t *)mxGetData(m))[0] = (uint64_t)(uintptr_t)object;
  give(a, m);
}

static void give_model(Call *a, hbvib_model *model) {
  a->model = model;
  give_handle(a, model);
}

static void give_branch(Call *a, hbvib_branch *branch) {
  a->branch[a->branch[0] != NULL] = branch;
  give_handle(a, branch);
}

static void give_batch(Call *a, hbvib_batch *batch) {
  a->batch = batch;
  give_handle(a, batch);
}

static void give_reals(Call *a, const double *x, int64_t n) {
  mxArray *m = mxCreateDoubleMatrix((mwSize)n, n ? 1 : 0, mxREAL);
  if (n) memcpy(mxGetPr(m), x, (size_t)n * sizeof *x);
  give(a, m);
}

static void give_complexes(Call *a, const double *x, int64_t n) {
  mxArray *m = mxCreateDoubleMatrix((mwSize)n, n ? 1 : 0, mxCOMPLEX);
  int64_t i;
  for (i = 0; i < n; i++) {
    mxGetPr(m)[i] = x[2 * i];
    mxGetPi(m)[i] = x[2 * i + 1];
  }
  give(a, m);
}

static void give_wholes(Call *a, const int64_t *x, int64_t n) {
  mxArray *m = mxCreateDoubleMatrix((mwSize)n, n ? 1 : 0, mxREAL);
  int64_t i;
  for (i = 0; i < n; i++) mxGetPr(m)[i] = (double)x[i];
  give(a, m);
}

static void give_wholes32(Call *a, const int32_t *x, int64_t n) {
  mxArray *m = mxCreateDoubleMatrix((mwSize)n, n ? 1 : 0, mxREAL);
  int64_t i;
  for (i = 0; i < n; i++) mxGetPr(m)[i] = x[i];
  give(a, m);
}

static void give_bytes(Call *a, const uint8_t *x, int64_t n) {
  mxArray *m = mxCreateNumericMatrix((mwSize)n, n ? 1 : 0, mxUINT8_CLASS, mxREAL);
  if (n) memcpy(mxGetData(m), x, (size_t)n);
  give(a, m);
}

/* A struct without its pointers, which the caller gave. */
static void give_struct(Call *a, const void *s, const Struct *of) {
  mxArray *m = mxCreateStructMatrix(1, 1, 0, NULL);
  size_t i, j;
  for (i = 0; i < of->count; i++) {
    const Field *f = &of->fields[i];
    const char *from = (const char *)s + f->offset;
    mxArray *value;
    if (f->kind > DOUBLE) continue;
    value = mxCreateDoubleMatrix(1, f->count, mxREAL);
    for (j = 0; j < f->count; j++) {
      mxGetPr(value)[j] = f->kind == INT32   ? ((const int32_t *)from)[j]
                          : f->kind == INT64 ? (double)((const int64_t *)from)[j]
                                             : ((const double *)from)[j];
    }
    mxAddField(m, f->name);
    mxSetField(m, 0, f->name, value);
  }
  give(a, m);
}

/* A copy of what a view shows, its first index first. */
static void give_view(Call *a, const hbvib_view *v) {
  int64_t n[3] = {1, 1, 1}, i, j, k, at = 0;
  mwSize shape[3];
  int32_t r;
  const int wide = v->scalar == HBVIB_COMPLEX;
  mxArray *m;
  for (r = 0; r < v->rank && r < 3; r++) n[r] = v->shape[r];
  for (r = 0; r < 3; r++) shape[r] = v->data ? (mwSize)n[r] : 0;
  m = mxCreateNumericArray(v->rank > 2 ? 3 : 2, shape, mxDOUBLE_CLASS, wide ? mxCOMPLEX : mxREAL);
  for (k = 0; v->data && k < n[2]; k++)
    for (j = 0; j < n[1]; j++)
      for (i = 0; i < n[0]; i++, at++) {
        const int64_t place = i * v->stride[0] + (v->rank > 1 ? j * v->stride[1] : 0) + (v->rank > 2 ? k * v->stride[2] : 0);
        mxGetPr(m)[at] = v->data[wide ? 2 * place : place];
        if (wide) mxGetPi(m)[at] = v->data[2 * place + 1];
      }
  give(a, m);
}

/* ---- Errors ---- */

/* Throws what a negative status means. The identifier has the name of the status without HBVIB_. */
static void check(hbvib_status status) {
  if (status < 0) {
    char id[64];
    snprintf(id, sizeof id, "hbvib:%s", hbvib_status_name(status) + strlen("HBVIB_"));
    mexErrMsgIdAndTxt(id, "%s", hbvib_last_error());
  }
}

/* After a call: objects that nobody will have are freed, then errors are thrown. */
static void finish(Call *a, hbvib_status status) {
  const int stopped_by_user = a->stopped && status == HBVIB_STOPPED_BY_CALLER;
  if (a->failure || stopped_by_user) {
    if (a->model) hbvib_model_free(a->model);
    if (a->branch[0]) hbvib_branch_free(a->branch[0]);
    if (a->branch[1]) hbvib_branch_free(a->branch[1]);
    if (a->batch) hbvib_batch_free(a->batch);
    if (a->failure) mexCallMATLAB(0, NULL, 1, &a->failure, "rethrow");
    mexErrMsgIdAndTxt("hbvib:interrupted", "%s: stopped by Ctrl-C", a->name);
  }
  check(status);
  give_number(a, status);
}

/* A count, or a negative status. */
static void give_count(Call *a, double result) {
  check(result < 0 ? (hbvib_status)result : HBVIB_OK);
  give_number(a, result);
}

/* The call that runs, whose `failure` a law fills; one at a time, as MATLAB has one thread. */
static Call *current = NULL;

/* ---- Hooks ---- */

static int32_t on_phase(void *user, const hbvib_phase_report *report) {
  Call *a = user;
  (void)report;
  a->stopped = a->stopped || interrupted();
  return a->stopped || a->failure;
}

static int32_t on_progress(void *user, const hbvib_progress *p) {
  static const char *names[] = {"newton_iterations", "point", "parameter", "amplitude", "residual", "step", "fraction_done"};
  Call *a = user;
  double values[7];
  mxArray *in[2], *out[1] = {NULL}, *thrown;
  int i, stop;
  a->stopped = a->stopped || interrupted();
  if (a->stopped || a->failure) return 1;
  if (!a->progress) return 0;
  values[0] = p->newton_iterations;
  values[1] = (double)p->point;
  values[2] = p->parameter;
  values[3] = p->amplitude;
  values[4] = p->residual;
  values[5] = p->step;
  values[6] = p->fraction_done;
  in[0] = a->progress;
  in[1] = mxCreateStructMatrix(1, 1, 7, names);
  for (i = 0; i < 7; i++) mxSetFieldByNumber(in[1], 0, i, mxCreateDoubleScalar(values[i]));
  thrown = mexCallMATLABWithTrap(1, out, 2, in, "feval");
  current = a; /* a call within the function has set it */
  mxDestroyArray(in[1]);
  if (thrown) {
    a->failure = thrown;
    return 1;
  }
  stop = out[0] && !mxIsEmpty(out[0]) && mxGetScalar(out[0]) == 0;
  if (out[0]) mxDestroyArray(out[0]);
  return stop;
}

static const hbvib_hooks *hooks(Call *a, const char *name) {
  const mxArray *m = next(a);
  hbvib_hooks_init(&a->hooks, sizeof a->hooks);
  a->hooks.user = a;
  a->hooks.phase = on_phase;
  a->hooks.progress = on_progress;
  if (!mxIsEmpty(m)) {
    if (!mxIsStruct(m)) refuse(a, name, "needs [] or a struct with the field progress");
    a->progress = mxGetField(m, 0, "progress");
    if (a->progress && mxIsEmpty(a->progress)) a->progress = NULL;
    if (a->progress && !mxIsClass(a->progress, "function_handle")) refuse(a, "progress", "needs a function handle");
  }
  return &a->hooks;
}

/* ---- Laws of the caller ---- */

/* An array of a period: its field of C, and the lengths of a sample, in letters of n and s; none is '1'. */
typedef struct {
  const char *name;
  size_t offset;
  char rows, columns;
} Sampled;

#define SAMPLED(name, rows, columns) {#name, offsetof(hbvib_force_call, name), rows, columns}
static const Sampled READ[] = {SAMPLED(u, 'n', '1'), SAMPLED(v, 'n', '1')};
static const Sampled WRITTEN[] = {
    SAMPLED(f, 'n', '1'),          SAMPLED(df_du, 'n', 'n'), SAMPLED(df_dv, 'n', 'n'),        SAMPLED(z, 's', '1'),
    SAMPLED(dz_dz, 's', 's'),      SAMPLED(dz_du, 's', 'n'), SAMPLED(dz_du_before, 's', 'n'), SAMPLED(dz_dv, 's', 'n'),
    SAMPLED(dz_dv_before, 's', 'n'), SAMPLED(dz_domega, 's', '1'), SAMPLED(df_dz, 'n', 's')};

static mwSize extent(const hbvib_force_call *call, char letter) {
  return letter == 'n' ? (mwSize)call->n : letter == 's' ? (mwSize)call->states : 1;
}

static double *sampled(const hbvib_force_call *call, const Sampled *s) {
  return *(double *const *)((const char *)call + s->offset);
}

/* A sentence as the failure of the call, for finish to throw. */
static int32_t law_fails(const char *what, const char *name) {
  static const char *names[] = {"message", "identifier"};
  char sentence[160];
  snprintf(sentence, sizeof sentence, "a law of the caller: %s%s", name, what);
  if (current) {
    current->failure = mxCreateStructMatrix(1, 1, 2, names);
    mxSetField(current->failure, 0, "message", mxCreateString(sentence));
    mxSetField(current->failure, 0, "identifier", mxCreateString("hbvib:input"));
  }
  return -1;
}

/* The numbers of a result: rows x columns x samples here, sample after sample and row after row in C. */
static int read_result(const hbvib_force_call *call, const Sampled *s, const mxArray *m) {
  const mwSize rows = extent(call, s->rows), columns = extent(call, s->columns), samples = (mwSize)call->samples;
  double *to = sampled(call, s);
  const double *from;
  mwSize i, j, k;
  if (!mxIsDouble(m) || mxIsComplex(m) || mxIsSparse(m) || mxGetNumberOfElements(m) != rows * columns * samples) return 0;
  from = mxGetPr(m);
  for (j = 0; j < samples; j++)
    for (i = 0; i < rows; i++)
      for (k = 0; k < columns; k++) to[(j * rows + i) * columns + k] = from[i + rows * (k + columns * j)];
  return 1;
}

/* Runs a law, a function handle: call -> struct with f and the derivatives that are not 0, or [] where it cannot. */
static int32_t on_force(void *user, const hbvib_force_call *call) {
  static const char *names[] = {"omega", "u", "v", "z0"};
  Call *outer = current;
  mxArray *in[2], *out[1] = {NULL}, *thrown;
  size_t i;
  if (outer && outer->failure) return -1;
  in[0] = user;
  in[1] = mxCreateStructMatrix(1, 1, 4, names);
  mxSetField(in[1], 0, "omega", mxCreateDoubleScalar(call->omega));
  for (i = 0; i < sizeof READ / sizeof *READ; i++) {
    const double *from = sampled(call, &READ[i]);
    mxArray *m = mxCreateDoubleMatrix((mwSize)call->n, from ? (mwSize)call->samples : 0, mxREAL);
    if (from) memcpy(mxGetPr(m), from, (size_t)(call->n * call->samples) * sizeof *from);
    mxSetField(in[1], 0, READ[i].name, m);
  }
  {
    mxArray *m = mxCreateDoubleMatrix((mwSize)call->states, 1, mxREAL);
    if (call->z0) memcpy(mxGetPr(m), call->z0, (size_t)call->states * sizeof *call->z0);
    mxSetField(in[1], 0, "z0", m);
  }
  thrown = mexCallMATLABWithTrap(1, out, 2, in, "feval");
  current = outer; /* a call within the law has set it */
  mxDestroyArray(in[1]);
  if (thrown) {
    if (outer) outer->failure = thrown;
    return -1;
  }
  if (!out[0] || mxIsEmpty(out[0])) return 1;
  if (mxIsStruct(out[0]) && mxGetField(out[0], 0, "failure")) { /* of internal.tried */
    if (outer) outer->failure = mxDuplicateArray(mxGetField(out[0], 0, "failure"));
    return -1;
  }
  if (!mxIsStruct(out[0])) return law_fails("gives no struct with the field f", "");
  for (i = 0; i < sizeof WRITTEN / sizeof *WRITTEN; i++) {
    const mxArray *m = mxGetField(out[0], 0, WRITTEN[i].name);
    if (!m || mxIsEmpty(m) || !sampled(call, &WRITTEN[i])) continue;
    if (!read_result(call, &WRITTEN[i], m)) return law_fails(" has another shape than rows x columns x samples", WRITTEN[i].name);
  }
  mxDestroyArray(out[0]);
  return 0;
}

/* hbvib_mex('model_add_user_force', model, struct('dofs', ..., 'uses_velocity', ...), law) -> number, status. The law is kept until
 * MATLAB ends, because copies and branches of the model may call it. */
static void call_model_add_user_force(Call *a) {
  static const char *known[] = {"dofs", "uses_velocity", "is_odd", "states", "samples"};
  hbvib_model *model = handle(a, "model");
  const mxArray *given = next(a), *law = next(a);
  hbvib_user_force force;
  mxArray *kept;
  int64_t id = 0;
  hbvib_status status;
  int k;
  hbvib_user_force_init(&force, sizeof force);
  if (!mxIsStruct(given) || mxGetNumberOfElements(given) != 1) refuse(a, "o", "needs a struct");
  if (!mxIsClass(law, "function_handle")) refuse(a, "law", "needs a function handle");
  for (k = 0; k < mxGetNumberOfFields(given); k++) {
    const char *key = mxGetFieldNameByNumber(given, k);
    const mxArray *value = mxGetFieldByNumber(given, 0, k);
    if (!strcmp(key, known[0])) force.dofs = wholes_of(a, key, value), force.n = (int64_t)mxGetNumberOfElements(value);
    else if (!strcmp(key, known[1])) force.uses_velocity = whole32_of(a, key, value);
    else if (!strcmp(key, known[2])) force.is_odd = whole32_of(a, key, value);
    else if (!strcmp(key, known[3])) force.states = whole_of(a, key, value);
    else if (!strcmp(key, known[4])) force.samples = whole_of(a, key, value);
    else mexErrMsgIdAndTxt("hbvib:input", "%s: there is no '%s', needs dofs, uses_velocity, is_odd, states, samples", a->name, key);
  }
  kept = mxDuplicateArray(law);
  mexMakeArrayPersistent(kept);
  force.force = on_force;
  force.user = kept;
  status = hbvib_model_add_user_force(model, &force, &id);
  if (status < 0) mxDestroyArray(kept);
  give_number(a, (double)id);
  finish(a, status);
}

/* BEGIN GENERATED by crates/bindings from hbvib.h */
static const Constant CONSTANTS[] = {
  {"OK", 0},
  {"STOPPED_BY_CALLER", 1},
  {"STOPPED_STEP_TOO_SMALL", 2},
  {"STOPPED_MAX_POINTS", 3},
  {"STOPPED_MAX_HARMONICS", 4},
  {"STOPPED_STALLED", 5},
  {"STOPPED_LEFT_RANGE", 6},
  {"STOPPED_CALLBACK", 7},
  {"STOPPED_UNBOUNDED", 8},
  {"STOPPED_NO_FORCE", 9},
  {"STOPPED_NO_PEAK", 10},
  {"STOPPED_PEAK_VANISHED", 11},
  {"STOPPED_CLOSED", 12},
  {"E_NULL", -1},
  {"E_ARGUMENT", -2},
  {"E_DIMENSION", -3},
  {"E_NOT_FINITE", -4},
  {"E_NOT_HERMITIAN", -5},
  {"E_SINGULAR", -6},
  {"E_NO_CONVERGENCE", -7},
  {"E_STRUCT_SIZE", -8},
  {"E_CALLBACK", -9},
  {"E_UNSUPPORTED", -10},
  {"E_OUT_OF_MEMORY", -11},
  {"E_NO_BOUNDED_SOLUTION", -12},
  {"E_HANDLE", -13},
  {"E_BUSY", -14},
  {"E_INDEX", -15},
  {"E_NOT_POSITIVE_DEFINITE", -16},
  {"E_INTERNAL", -99},
  {"COL_MAJOR", 0},
  {"ROW_MAJOR", 1},
  {"CSC", 2},
  {"REAL", 0},
  {"COMPLEX", 1},
  {"FULL", 0},
  {"LOWER", 1},
  {"UPPER", 2},
  {"GENERAL", 3},
  {"SYMMETRIC", 4},
  {"SYMMETRIC_LOWER", 5},
  {"SYMMETRIC_UPPER", 6},
  {"MASS", 0},
  {"DAMPING", 1},
  {"STIFFNESS", 2},
  {"STRUCTURAL", 3},
  {"GYROSCOPIC", 4},
  {"STIFFNESS_SPEED2", 5},
  {"GROUND", -1},
  {"BLOCK_OWN", 0},
  {"BLOCK_NEXT", 1},
  {"BLOCK_PREVIOUS", 2},
  {"DIAMETER_OF_ENGINE_ORDER", -2147483647},
  {"AERO_DISPLACEMENT", 0},
  {"AERO_VELOCITY", 1},
  {"CARTESIAN", 0},
  {"CYLINDRICAL", 1},
  {"MISTUNING_STIFFNESS", 0},
  {"MISTUNING_FREQUENCY", 1},
  {"MISTUNING_MASS", 2},
  {"MISTUNING_DAMPING", 3},
  {"MISTUNING_PRELOAD", 4},
  {"MISTUNING_FORCE", 5},
  {"JENKINS", 1},
  {"FRICTION_2D", 2},
  {"FRICTION_3D", 3},
  {"UNILATERAL", 4},
  {"CUBIC", 5},
  {"REGULARISED", 6},
  {"TABLE", 7},
  {"POLYNOMIAL", 8},
  {"CALLER_LAW", 9},
  {"DF_DU", 0},
  {"DF_DV", 1},
  {"DF_DZ", 2},
  {"DZ_DZ", 3},
  {"DZ_DU_BEFORE", 4},
  {"DZ_DU", 5},
  {"DZ_DV_BEFORE", 6},
  {"DZ_DV", 7},
  {"DZ_DOMEGA", 8},
  {"FLEXIBILITY_AUTOMATIC", 0},
  {"FLEXIBILITY_DIRECT", 1},
  {"FLEXIBILITY_KRYLOV", 2},
  {"STABILITY_NONE", 0},
  {"STABILITY_WAVE", 1},
  {"STABILITY_WHEEL", 2},
  {"LOG_NONE", 0},
  {"LOG_WARN", 1},
  {"LOG_INFO", 2},
  {"LOG_DEBUG", 3},
  {"PHASE_SETUP", 0},
  {"PHASE_MODES", 1},
  {"PHASE_CONDENSATION", 2},
  {"PHASE_FIRST_POINT", 3},
  {"PHASE_CONTINUATION", 4},
  {"PHASE_ESTIMATE", 5},
  {"PHASE_TIME_INTEGRATION", 6},
  {"PHASE_RESULTS", 7},
  {"PHASE_FACTORISATION", 8},
  {"MEASURE_FUNDAMENTAL", 0},
  {"MEASURE_HARMONIC", 1},
  {"MEASURE_PEAK", 2},
  {"MEASURE_RMS", 3},
  {"MEASURE_RANGE", 4},
  {"DISPLACEMENT", 0},
  {"VELOCITY", 1},
  {"ACCELERATION", 2},
  {"OMEGA", 0},
  {"AMPLITUDE", 1},
  {"DAMPING_RATIO", 2},
  {"ENERGY", 3},
  {"DISSIPATION", 4},
  {"RESIDUAL", 5},
  {"NEWTON_ITERATIONS", 6},
  {"ERROR_ESTIMATE", 7},
  {"HARMONICS_USED", 8},
  {"SLIP_FRACTION", 9},
  {"LOG10_AMPLITUDE", 10},
  {"MODAL_AMPLITUDE", 11},
  {"STRUCTURAL_LOSS", 12},
  {"MODAL_ASSURANCE", 13},
  {"SAMPLING_ERROR", 14},
  {"DAMPING_ERROR_ESTIMATE", 15},
  {"FLOQUET_RADIUS", 16},
  {"UNSTABLE_DIRECTIONS", 17},
  {"PARAMETER_VALUE", 18},
  {"D_AMPLITUDE", 19},
  {"D_DAMPING", 20},
  {"FREE_SLIDERS", 21},
  {"D_AMPLITUDE_BY_PLACE", 22},
  {"READING_VALUE", 0},
  {"READING_COMPLEX", 1},
  {"READING_ERROR", 2},
  {"READING_INSTANT", 3},
  {"FLEXIBILITY_WAY_SINGLE_FREQUENCY", 0},
  {"FLEXIBILITY_WAY_MODES", 1},
  {"FLEXIBILITY_WAY_POLES", 2},
  {"FLEXIBILITY_WAY_NEAR_RIGID", 3},
  {"FLEXIBILITY_WAY_FEW", 4},
  {"FLEXIBILITY_WAY_SPARSE", 5},
  {"FLEXIBILITY_WAY_MANY", 6},
  {"FLEXIBILITY_WAY_UNSUITABLE", 7},
  {"FLEXIBILITY_WAY_DISAGREEMENT", 8},
  {"FLEXIBILITY_WAY_TUNED_WHEEL", 9},
  {"STATE_STICK", 0},
  {"STATE_SLIP", 1},
  {"STATE_OPEN", 2},
  {"CONTACTS_FREE", 0},
  {"CONTACTS_STUCK", 1},
  {"CONTACTS_STATIC", 2},
  {"DAMPING_MASS", 0},
  {"DAMPING_STIFFNESS", 1},
  {"MODE_SINGLE", 0},
  {"MODE_TRAVELLING_WAVE", 1},
  {"MODE_PROJECTED", 2},
  {"MODE_FIRST", 3},
  {"SYNTHESIS_VALID", 0},
  {"SYNTHESIS_ANOTHER_MODE", 1},
  {"SYNTHESIS_INTERNAL_RESONANCE", 2},
  {"SYNTHESIS_FALLING", 4},
  {"SYNTHESIS_INACCURATE", 8},
  {"SHOOTING", 0},
  {"MARCHING", 1},
  {"WAVES_WAVE", 0},
  {"WAVES_WHEEL", 1},
  {"MULTIPLIER_ORDINARY", 0},
  {"MULTIPLIER_MEMORY", 1},
  {"MULTIPLIER_NEUTRAL_STUCK", 2},
  {"MULTIPLIER_NEUTRAL_RIGID", 3},
  {"MULTIPLIER_TRIVIAL", 4},
  {"GRAZING_NONE", 0},
  {"GRAZING_SLIP_LIMIT", 1},
  {"GRAZING_LANDING", 2},
  {"BIFURCATION_FOLD", 0},
  {"BIFURCATION_PERIOD_DOUBLING", 1},
  {"BIFURCATION_NEIMARK_SACKER", 2},
  {"BIFURCATION_BRANCH_POINT", 3},
  {"PARAMETER_FORCE", 0},
  {"PARAMETER_PRELOAD", 1},
  {"PARAMETER_MU", 2},
  {"PARAMETER_KT", 3},
  {"PARAMETER_KN", 4},
  {"PARAMETER_GAP", 5},
  {"PARAMETER_MASS", 6},
  {"PARAMETER_DAMPING", 7},
  {"PARAMETER_STIFFNESS", 8},
  {"PARAMETER_SPEED", 9},
  {"PARAMETER_SLIDER_T1", 10},
  {"PARAMETER_SLIDER_T2", 11},
  {"SCALING_ADDITIVE", 0},
  {"SCALING_FACTOR", 1},
  {"OF_AMPLITUDE", 0},
  {"OF_PEAK_AMPLITUDE", 1},
  {"OF_PEAK_OMEGA", 2},
  {"OF_MODE_OMEGA", 3},
  {"OF_MODE_DAMPING", 4},
  {"OF_RESPONSE", 1000000},
  {"OF_RESPONSE_PEAK_OMEGA", 2000000},
  {"DERIVATIVE_EXISTS", 0},
  {"DERIVATIVE_ONSET_OF_SLIP", 1},
  {"DERIVATIVE_ONE_SIDED", 2},
  {"DERIVATIVE_FOLD", 3},
  {"FOLLOW_OMEGA", 0},
  {"FOLLOW_PEAK", 1},
  {"FOLLOW_FOLD", 2},
  {"FOLLOW_MODE_MAX_DAMPING", 3},
  {"FOLLOW_PEAK_THROUGH_FOLDS", 4},
  {"BAND_AMPLITUDE", 0},
  {"BAND_PEAK_AMPLITUDE", 1},
  {"BAND_PEAK_OMEGA", 2},
  {"MODE_BAND_DAMPING", 0},
  {"MODE_BAND_OMEGA", 1},
  {"LIFE_DUTIES", 0},
  {"LIFE_PEAK", 1},
  {"LIFE_SLIPS", 0},
  {"LIFE_STICKS", 1},
  {"LIFE_LOST", 2},
  {"LIFE_PRESSED", 3},
  {"LIFE_LIMIT", 4},
  {"LIFE_JUMPS", 5},
  {"DATA_RESPONSE", 0},
  {"DATA_AMPLITUDE", 1},
  {"DATA_PEAK", 2},
  {"DATA_BACKBONE", 3},
  {"DATA_LINEAR_MODE", 4},
  {"SCALE_AUTOMATIC", 0},
  {"SCALE_LINEAR", 1},
  {"SCALE_LOG", 2},
  {"SUSPICION_NONE", 0},
  {"SUSPICION_RESPONSE", 1},
  {"SUSPICION_FREQUENCY", 2},
};

static const Struct MATRIX_STRUCT;
static const Struct SECTOR_STRUCT;
static const Struct CONTACT_STRUCT;
static const Struct DAMPER_FACE_STRUCT;
static const Struct DAMPER_STRUCT;
static const Struct JACOBIAN_GAP_STRUCT;
static const Struct SOLVER_OPTIONS_STRUCT;
static const Struct RESPONSE_STRUCT;
static const Struct FORCED_OPTIONS_STRUCT;
static const Struct DESCENT_STRUCT;
static const Struct SEARCHED_STRUCT;
static const Struct REDUCTION_STRUCT;
static const Struct ENERGY_STRUCT;
static const Struct CONTACT_SUMMARY_STRUCT;
static const Struct MODE_OPTIONS_STRUCT;
static const Struct MODE_POINT_STRUCT;
static const Struct MODE_INFO_STRUCT;
static const Struct SYNTHESIS_OPTIONS_STRUCT;
static const Struct TIME_OPTIONS_STRUCT;
static const Struct TIME_INFO_STRUCT;
static const Struct SWEEP_OPTIONS_STRUCT;
static const Struct SWEEP_INFO_STRUCT;
static const Struct RUN_UP_OPTIONS_STRUCT;
static const Struct RUN_UP_INFO_STRUCT;
static const Struct MISSION_OPTIONS_STRUCT;
static const Struct CAMPBELL_OPTIONS_STRUCT;
static const Struct VERIFY_OPTIONS_STRUCT;
static const Struct VERIFICATION_STRUCT;
static const Struct FLOQUET_OPTIONS_STRUCT;
static const Struct FLOQUET_INFO_STRUCT;
static const Struct KICK_STRUCT;
static const Struct PARAMETER_STRUCT;
static const Struct PARAMETER_OPTIONS_STRUCT;
static const Struct BATCH_OPTIONS_STRUCT;
static const Struct WHEEL_INFO_STRUCT;
static const Struct BAND_OPTIONS_STRUCT;
static const Struct BAND_INFO_STRUCT;
static const Struct LIFE_OPTIONS_STRUCT;
static const Struct LIFE_INFO_STRUCT;
static const Struct BEST_LOAD_STRUCT;
static const Struct DATA_STRUCT;
static const Struct UNKNOWN_STRUCT;
static const Struct FIT_OPTIONS_STRUCT;
static const Struct FIT_INFO_STRUCT;
static const Struct FIT_PROFILE_INFO_STRUCT;
static const Field matrix_fields[] = {
  {"storage", INT32, offsetof(hbvib_matrix, storage), 1, NULL},
  {"scalar", INT32, offsetof(hbvib_matrix, scalar), 1, NULL},
  {"part", INT32, offsetof(hbvib_matrix, part), 1, NULL},
  {"rows", INT64, offsetof(hbvib_matrix, rows), 1, NULL},
  {"cols", INT64, offsetof(hbvib_matrix, cols), 1, NULL},
  {"ld", INT64, offsetof(hbvib_matrix, ld), 1, NULL},
  {"values", DOUBLES, offsetof(hbvib_matrix, values), 1, NULL},
  {"col_ptr", INT64S, offsetof(hbvib_matrix, col_ptr), 1, NULL},
  {"row_idx", INT64S, offsetof(hbvib_matrix, row_idx), 1, NULL},
  {"index_base", INT32, offsetof(hbvib_matrix, index_base), 1, NULL},
};
static hbvib_status matrix_fill(void *s) { return hbvib_matrix_init(s, sizeof(hbvib_matrix)); }
static const Struct MATRIX_STRUCT = {"matrix", sizeof(hbvib_matrix), matrix_fields, sizeof matrix_fields / sizeof *matrix_fields, matrix_fill};

static const Field sector_fields[] = {
  {"frame", INT32, offsetof(hbvib_sector, frame), 1, NULL},
  {"ndof", INT64, offsetof(hbvib_sector, ndof), 1, NULL},
  {"sectors", INT64, offsetof(hbvib_sector, sectors), 1, NULL},
  {"engine_order", INT64, offsetof(hbvib_sector, engine_order), 1, NULL},
  {"components", INT64, offsetof(hbvib_sector, components), 1, NULL},
  {"left", INT64S, offsetof(hbvib_sector, left), 1, NULL},
  {"left_len", INT64, offsetof(hbvib_sector, left_len), 1, NULL},
  {"right", INT64S, offsetof(hbvib_sector, right), 1, NULL},
  {"right_len", INT64, offsetof(hbvib_sector, right_len), 1, NULL},
  {"fixed", INT64S, offsetof(hbvib_sector, fixed), 1, NULL},
  {"fixed_len", INT64, offsetof(hbvib_sector, fixed_len), 1, NULL},
  {"axis", DOUBLE, offsetof(hbvib_sector, axis), 3, NULL},
  {"direction", INT32, offsetof(hbvib_sector, direction), 1, NULL},
  {"left_coordinates", DOUBLES, offsetof(hbvib_sector, left_coordinates), 1, NULL},
  {"right_coordinates", DOUBLES, offsetof(hbvib_sector, right_coordinates), 1, NULL},
};
static hbvib_status sector_fill(void *s) { return hbvib_sector_init(s, sizeof(hbvib_sector)); }
static const Struct SECTOR_STRUCT = {"sector", sizeof(hbvib_sector), sector_fields, sizeof sector_fields / sizeof *sector_fields, sector_fill};

static const Field contact_fields[] = {
  {"kind", INT32, offsetof(hbvib_contact, kind), 1, NULL},
  {"dof_a", INT64, offsetof(hbvib_contact, dof_a), 3, NULL},
  {"dof_b", INT64, offsetof(hbvib_contact, dof_b), 3, NULL},
  {"sector_offset", INT64, offsetof(hbvib_contact, sector_offset), 1, NULL},
  {"kt", DOUBLE, offsetof(hbvib_contact, kt), 1, NULL},
  {"kn", DOUBLE, offsetof(hbvib_contact, kn), 1, NULL},
  {"mu", DOUBLE, offsetof(hbvib_contact, mu), 1, NULL},
  {"preload", DOUBLE, offsetof(hbvib_contact, preload), 1, NULL},
  {"gap", DOUBLE, offsetof(hbvib_contact, gap), 1, NULL},
  {"cubic", DOUBLE, offsetof(hbvib_contact, cubic), 1, NULL},
  {"velocity", DOUBLE, offsetof(hbvib_contact, velocity), 1, NULL},
  {"normal", DOUBLE, offsetof(hbvib_contact, normal), 3, NULL},
  {"tangent", DOUBLE, offsetof(hbvib_contact, tangent), 3, NULL},
  {"rotation", INT64, offsetof(hbvib_contact, rotation), 3, NULL},
  {"arm", DOUBLE, offsetof(hbvib_contact, arm), 3, NULL},
  {"turn", DOUBLE, offsetof(hbvib_contact, turn), 1, NULL},
};
static hbvib_status contact_fill(void *s) { return hbvib_contact_init(s, sizeof(hbvib_contact)); }
static const Struct CONTACT_STRUCT = {"contact", sizeof(hbvib_contact), contact_fields, sizeof contact_fields / sizeof *contact_fields, contact_fill};

static const Field damper_face_fields[] = {
  {"dofs", INT64, offsetof(hbvib_damper_face, dofs), 3, NULL},
  {"sector_offset", INT64, offsetof(hbvib_damper_face, sector_offset), 1, NULL},
  {"angle", DOUBLE, offsetof(hbvib_damper_face, angle), 1, NULL},
  {"turn", DOUBLE, offsetof(hbvib_damper_face, turn), 1, NULL},
  {"centre", DOUBLE, offsetof(hbvib_damper_face, centre), 3, NULL},
  {"width", DOUBLE, offsetof(hbvib_damper_face, width), 1, NULL},
  {"points_across", INT64, offsetof(hbvib_damper_face, points_across), 1, NULL},
  {"points_along", INT64, offsetof(hbvib_damper_face, points_along), 1, NULL},
  {"kt", DOUBLE, offsetof(hbvib_damper_face, kt), 1, NULL},
  {"kn", DOUBLE, offsetof(hbvib_damper_face, kn), 1, NULL},
  {"mu", DOUBLE, offsetof(hbvib_damper_face, mu), 1, NULL},
  {"gap", DOUBLE, offsetof(hbvib_damper_face, gap), 1, NULL},
};
static hbvib_status damper_face_fill(void *s) { return hbvib_damper_face_init(s, sizeof(hbvib_damper_face)); }
static const Struct DAMPER_FACE_STRUCT = {"damper_face", sizeof(hbvib_damper_face), damper_face_fields, sizeof damper_face_fields / sizeof *damper_face_fields, damper_face_fill};

static const Field damper_fields[] = {
  {"motions", INT32, offsetof(hbvib_damper, motions), 1, NULL},
  {"mass", DOUBLE, offsetof(hbvib_damper, mass), 1, NULL},
  {"inertia", DOUBLE, offsetof(hbvib_damper, inertia), 3, NULL},
  {"radius", DOUBLE, offsetof(hbvib_damper, radius), 1, NULL},
  {"length", DOUBLE, offsetof(hbvib_damper, length), 1, NULL},
  {"orbit", DOUBLE, offsetof(hbvib_damper, orbit), 1, NULL},
  {"support", DOUBLE, offsetof(hbvib_damper, support), 2, NULL},
  {"support_damping", DOUBLE, offsetof(hbvib_damper, support_damping), 2, NULL},
  {"faces", STRUCTS, offsetof(hbvib_damper, faces), 1, &DAMPER_FACE_STRUCT},
  {"faces_len", INT64, offsetof(hbvib_damper, faces_len), 1, NULL},
};
static hbvib_status damper_fill(void *s) { return hbvib_damper_init(s, sizeof(hbvib_damper)); }
static const Struct DAMPER_STRUCT = {"damper", sizeof(hbvib_damper), damper_fields, sizeof damper_fields / sizeof *damper_fields, damper_fill};

static const Field jacobian_gap_fields[] = {
  {"tangent", INT32, offsetof(hbvib_jacobian_gap, tangent), 1, NULL},
  {"gap", DOUBLE, offsetof(hbvib_jacobian_gap, gap), 1, NULL},
  {"sample", INT64, offsetof(hbvib_jacobian_gap, sample), 1, NULL},
  {"row", INT64, offsetof(hbvib_jacobian_gap, row), 1, NULL},
  {"column", INT64, offsetof(hbvib_jacobian_gap, column), 1, NULL},
  {"given", DOUBLE, offsetof(hbvib_jacobian_gap, given), 1, NULL},
  {"difference", DOUBLE, offsetof(hbvib_jacobian_gap, difference), 1, NULL},
};
static hbvib_status jacobian_gap_fill(void *s) { return hbvib_jacobian_gap_init(s, sizeof(hbvib_jacobian_gap)); }
static const Struct JACOBIAN_GAP_STRUCT = {"jacobian_gap", sizeof(hbvib_jacobian_gap), jacobian_gap_fields, sizeof jacobian_gap_fields / sizeof *jacobian_gap_fields, jacobian_gap_fill};

static const Field solver_options_fields[] = {
  {"num_threads", INT32, offsetof(hbvib_solver_options, num_threads), 1, NULL},
  {"tolerance", DOUBLE, offsetof(hbvib_solver_options, tolerance), 1, NULL},
  {"harmonics", INT64, offsetof(hbvib_solver_options, harmonics), 1, NULL},
  {"max_harmonics", INT64, offsetof(hbvib_solver_options, max_harmonics), 1, NULL},
  {"samples", INT64, offsetof(hbvib_solver_options, samples), 1, NULL},
  {"step", DOUBLE, offsetof(hbvib_solver_options, step), 1, NULL},
  {"step_min", DOUBLE, offsetof(hbvib_solver_options, step_min), 1, NULL},
  {"step_max", DOUBLE, offsetof(hbvib_solver_options, step_max), 1, NULL},
  {"tol_residual", DOUBLE, offsetof(hbvib_solver_options, tol_residual), 1, NULL},
  {"max_newton", INT64, offsetof(hbvib_solver_options, max_newton), 1, NULL},
  {"max_points", INT64, offsetof(hbvib_solver_options, max_points), 1, NULL},
  {"response_dof", INT64, offsetof(hbvib_solver_options, response_dof), 1, NULL},
  {"keep_even_harmonics", INT32, offsetof(hbvib_solver_options, keep_even_harmonics), 1, NULL},
  {"estimate_error", INT32, offsetof(hbvib_solver_options, estimate_error), 1, NULL},
  {"memory_limit", INT64, offsetof(hbvib_solver_options, memory_limit), 1, NULL},
  {"flexibility", INT32, offsetof(hbvib_solver_options, flexibility), 1, NULL},
  {"stability", INT32, offsetof(hbvib_solver_options, stability), 1, NULL},
  {"freedom", INT32, offsetof(hbvib_solver_options, freedom), 1, NULL},
};
static hbvib_status solver_options_fill(void *s) { return hbvib_solver_options_init(s, sizeof(hbvib_solver_options)); }
static const Struct SOLVER_OPTIONS_STRUCT = {"solver_options", sizeof(hbvib_solver_options), solver_options_fields, sizeof solver_options_fields / sizeof *solver_options_fields, solver_options_fill};

static const Field response_fields[] = {
  {"measure", INT32, offsetof(hbvib_response, measure), 1, NULL},
  {"harmonic", INT64, offsetof(hbvib_response, harmonic), 1, NULL},
  {"n", INT64, offsetof(hbvib_response, n), 1, NULL},
  {"dofs", INT64S, offsetof(hbvib_response, dofs), 1, NULL},
  {"weights", DOUBLES, offsetof(hbvib_response, weights), 1, NULL},
  {"sector", INT64, offsetof(hbvib_response, sector), 1, NULL},
  {"component", INT32, offsetof(hbvib_response, component), 1, NULL},
};
static hbvib_status response_fill(void *s) { return hbvib_response_init(s, sizeof(hbvib_response)); }
static const Struct RESPONSE_STRUCT = {"response", sizeof(hbvib_response), response_fields, sizeof response_fields / sizeof *response_fields, response_fill};

static const Field forced_options_fields[] = {
  {"together", INT32, offsetof(hbvib_forced_options, together), 1, NULL},
  {"omega_start", DOUBLE, offsetof(hbvib_forced_options, omega_start), 1, NULL},
  {"omega_stop", DOUBLE, offsetof(hbvib_forced_options, omega_stop), 1, NULL},
  {"at", DOUBLES, offsetof(hbvib_forced_options, at), 1, NULL},
  {"at_len", INT64, offsetof(hbvib_forced_options, at_len), 1, NULL},
  {"guess", COMPLEXES, offsetof(hbvib_forced_options, guess), 1, NULL},
  {"guess_len", INT64, offsetof(hbvib_forced_options, guess_len), 1, NULL},
  {"responses", STRUCTS, offsetof(hbvib_forced_options, responses), 1, &RESPONSE_STRUCT},
  {"responses_len", INT64, offsetof(hbvib_forced_options, responses_len), 1, NULL},
  {"branches", INT32, offsetof(hbvib_forced_options, branches), 1, NULL},
  {"branch_depth", INT32, offsetof(hbvib_forced_options, branch_depth), 1, NULL},
  {"most_branches", INT64, offsetof(hbvib_forced_options, most_branches), 1, NULL},
};
static hbvib_status forced_options_fill(void *s) { return hbvib_forced_options_init(s, sizeof(hbvib_forced_options)); }
static const Struct FORCED_OPTIONS_STRUCT = {"forced_options", sizeof(hbvib_forced_options), forced_options_fields, sizeof forced_options_fields / sizeof *forced_options_fields, forced_options_fill};

static const Field descent_fields[] = {
  {"kind", INT32, offsetof(hbvib_descent, kind), 1, NULL},
  {"bifurcation", INT64, offsetof(hbvib_descent, bifurcation), 1, NULL},
  {"periods", INT64, offsetof(hbvib_descent, periods), 1, NULL},
  {"merges_at", DOUBLE, offsetof(hbvib_descent, merges_at), 1, NULL},
  {"mode", INT64, offsetof(hbvib_descent, mode), 1, NULL},
  {"born_at_force", DOUBLE, offsetof(hbvib_descent, born_at_force), 1, NULL},
  {"merges_at_force", DOUBLE, offsetof(hbvib_descent, merges_at_force), 1, NULL},
  {"internal_resonance", INT64, offsetof(hbvib_descent, internal_resonance), 1, NULL},
};
static hbvib_status descent_fill(void *s) { return hbvib_descent_init(s, sizeof(hbvib_descent)); }
static const Struct DESCENT_STRUCT = {"descent", sizeof(hbvib_descent), descent_fields, sizeof descent_fields / sizeof *descent_fields, descent_fill};

static const Field searched_fields[] = {
  {"bifurcations", INT64, offsetof(hbvib_searched, bifurcations), 1, NULL},
  {"lost", INT64, offsetof(hbvib_searched, lost), 1, NULL},
  {"left", INT64, offsetof(hbvib_searched, left), 1, NULL},
  {"modes", INT64, offsetof(hbvib_searched, modes), 1, NULL},
  {"incomplete_modes", INT64, offsetof(hbvib_searched, incomplete_modes), 1, NULL},
  {"resonances", INT64, offsetof(hbvib_searched, resonances), 1, NULL},
  {"lost_resonances", INT64, offsetof(hbvib_searched, lost_resonances), 1, NULL},
  {"amplitude_min", DOUBLE, offsetof(hbvib_searched, amplitude_min), 1, NULL},
  {"amplitude_max", DOUBLE, offsetof(hbvib_searched, amplitude_max), 1, NULL},
  {"starts", INT64, offsetof(hbvib_searched, starts), 1, NULL},
  {"force_curves", INT64, offsetof(hbvib_searched, force_curves), 1, NULL},
  {"incomplete_force_curves", INT64, offsetof(hbvib_searched, incomplete_force_curves), 1, NULL},
  {"crossings", INT64, offsetof(hbvib_searched, crossings), 1, NULL},
  {"deflations", INT64, offsetof(hbvib_searched, deflations), 1, NULL},
  {"deflated", INT64, offsetof(hbvib_searched, deflated), 1, NULL},
};
static hbvib_status searched_fill(void *s) { return hbvib_searched_init(s, sizeof(hbvib_searched)); }
static const Struct SEARCHED_STRUCT = {"searched", sizeof(hbvib_searched), searched_fields, sizeof searched_fields / sizeof *searched_fields, searched_fill};

static const Field reduction_fields[] = {
  {"sectors", INT64, offsetof(hbvib_reduction, sectors), 1, NULL},
  {"degrees_of_freedom", INT64, offsetof(hbvib_reduction, degrees_of_freedom), 1, NULL},
  {"coordinates", INT64, offsetof(hbvib_reduction, coordinates), 1, NULL},
  {"contacts", INT64, offsetof(hbvib_reduction, contacts), 1, NULL},
  {"never_slipping", INT64, offsetof(hbvib_reduction, never_slipping), 1, NULL},
  {"inert", INT64, offsetof(hbvib_reduction, inert), 1, NULL},
  {"harmonics_asked", INT64, offsetof(hbvib_reduction, harmonics_asked), 1, NULL},
  {"harmonics_carried", INT64, offsetof(hbvib_reduction, harmonics_carried), 1, NULL},
  {"unknowns", INT64, offsetof(hbvib_reduction, unknowns), 1, NULL},
  {"response_dof", INT64, offsetof(hbvib_reduction, response_dof), 1, NULL},
  {"mean_carried", INT32, offsetof(hbvib_reduction, mean_carried), 1, NULL},
  {"even_removed", INT32, offsetof(hbvib_reduction, even_removed), 1, NULL},
  {"held_by_contacts", INT64, offsetof(hbvib_reduction, held_by_contacts), 1, NULL},
  {"basis", INT64, offsetof(hbvib_reduction, basis), 1, NULL},
  {"certificate", DOUBLE, offsetof(hbvib_reduction, certificate), 1, NULL},
  {"response_harmonic", INT64, offsetof(hbvib_reduction, response_harmonic), 1, NULL},
  {"guess_used", INT32, offsetof(hbvib_reduction, guess_used), 1, NULL},
  {"flexibility_way", INT32, offsetof(hbvib_reduction, flexibility_way), 1, NULL},
};
static hbvib_status reduction_fill(void *s) { return hbvib_reduction_init(s, sizeof(hbvib_reduction)); }
static const Struct REDUCTION_STRUCT = {"reduction", sizeof(hbvib_reduction), reduction_fields, sizeof reduction_fields / sizeof *reduction_fields, reduction_fill};

static const Field energy_fields[] = {
  {"twice_mean_kinetic", DOUBLE, offsetof(hbvib_energy, twice_mean_kinetic), 1, NULL},
  {"kinetic_mean", DOUBLE, offsetof(hbvib_energy, kinetic_mean), 1, NULL},
  {"kinetic_peak", DOUBLE, offsetof(hbvib_energy, kinetic_peak), 1, NULL},
  {"potential_mean", DOUBLE, offsetof(hbvib_energy, potential_mean), 1, NULL},
  {"potential_peak", DOUBLE, offsetof(hbvib_energy, potential_peak), 1, NULL},
  {"wheel_kinetic_mean", DOUBLE, offsetof(hbvib_energy, wheel_kinetic_mean), 1, NULL},
  {"wheel_kinetic_peak", DOUBLE, offsetof(hbvib_energy, wheel_kinetic_peak), 1, NULL},
  {"wheel_potential_mean", DOUBLE, offsetof(hbvib_energy, wheel_potential_mean), 1, NULL},
  {"wheel_potential_peak", DOUBLE, offsetof(hbvib_energy, wheel_potential_peak), 1, NULL},
  {"structural_loss", DOUBLE, offsetof(hbvib_energy, structural_loss), 1, NULL},
  {"friction_loss", DOUBLE, offsetof(hbvib_energy, friction_loss), 1, NULL},
};
static hbvib_status energy_fill(void *s) { return hbvib_energy_init(s, sizeof(hbvib_energy)); }
static const Struct ENERGY_STRUCT = {"energy", sizeof(hbvib_energy), energy_fields, sizeof energy_fields / sizeof *energy_fields, energy_fill};

static const Field contact_summary_fields[] = {
  {"work", DOUBLE, offsetof(hbvib_contact_summary, work), 1, NULL},
  {"slip_share", DOUBLE, offsetof(hbvib_contact_summary, slip_share), 1, NULL},
  {"open_share", DOUBLE, offsetof(hbvib_contact_summary, open_share), 1, NULL},
  {"half_range", DOUBLE, offsetof(hbvib_contact_summary, half_range), 1, NULL},
  {"motion_min", DOUBLE, offsetof(hbvib_contact_summary, motion_min), 1, NULL},
  {"motion_max", DOUBLE, offsetof(hbvib_contact_summary, motion_max), 1, NULL},
  {"load_min", DOUBLE, offsetof(hbvib_contact_summary, load_min), 1, NULL},
  {"load_max", DOUBLE, offsetof(hbvib_contact_summary, load_max), 1, NULL},
  {"directions", INT64, offsetof(hbvib_contact_summary, directions), 1, NULL},
  {"all_min", DOUBLE, offsetof(hbvib_contact_summary, all_min), 3, NULL},
  {"all_max", DOUBLE, offsetof(hbvib_contact_summary, all_max), 3, NULL},
};
static hbvib_status contact_summary_fill(void *s) { return hbvib_contact_summary_init(s, sizeof(hbvib_contact_summary)); }
static const Struct CONTACT_SUMMARY_STRUCT = {"contact_summary", sizeof(hbvib_contact_summary), contact_summary_fields, sizeof contact_summary_fields / sizeof *contact_summary_fields, contact_summary_fill};

static const Field mode_options_fields[] = {
  {"damping_form", INT32, offsetof(hbvib_mode_options, damping_form), 1, NULL},
  {"log10_start", DOUBLE, offsetof(hbvib_mode_options, log10_start), 1, NULL},
  {"log10_stop", DOUBLE, offsetof(hbvib_mode_options, log10_stop), 1, NULL},
  {"diameter", INT64, offsetof(hbvib_mode_options, diameter), 1, NULL},
  {"mode_index", INT64, offsetof(hbvib_mode_options, mode_index), 1, NULL},
  {"near_omega", DOUBLE, offsetof(hbvib_mode_options, near_omega), 1, NULL},
  {"shape", COMPLEXES, offsetof(hbvib_mode_options, shape), 1, NULL},
  {"shape_len", INT64, offsetof(hbvib_mode_options, shape_len), 1, NULL},
  {"amplitude_contact", INT64, offsetof(hbvib_mode_options, amplitude_contact), 1, NULL},
  {"at", DOUBLES, offsetof(hbvib_mode_options, at), 1, NULL},
  {"at_len", INT64, offsetof(hbvib_mode_options, at_len), 1, NULL},
  {"reference_dof", INT64, offsetof(hbvib_mode_options, reference_dof), 1, NULL},
  {"guess", COMPLEXES, offsetof(hbvib_mode_options, guess), 1, NULL},
  {"guess_len", INT64, offsetof(hbvib_mode_options, guess_len), 1, NULL},
  {"guess_omega", DOUBLE, offsetof(hbvib_mode_options, guess_omega), 1, NULL},
  {"guess_damping", DOUBLE, offsetof(hbvib_mode_options, guess_damping), 1, NULL},
  {"branches", INT32, offsetof(hbvib_mode_options, branches), 1, NULL},
  {"branch_depth", INT32, offsetof(hbvib_mode_options, branch_depth), 1, NULL},
  {"most_branches", INT64, offsetof(hbvib_mode_options, most_branches), 1, NULL},
};
static hbvib_status mode_options_fill(void *s) { return hbvib_mode_options_init(s, sizeof(hbvib_mode_options)); }
static const Struct MODE_OPTIONS_STRUCT = {"mode_options", sizeof(hbvib_mode_options), mode_options_fields, sizeof mode_options_fields / sizeof *mode_options_fields, mode_options_fill};

static const Field mode_point_fields[] = {
  {"log10_amplitude", DOUBLE, offsetof(hbvib_mode_point, log10_amplitude), 1, NULL},
  {"omega", DOUBLE, offsetof(hbvib_mode_point, omega), 1, NULL},
  {"damping_ratio", DOUBLE, offsetof(hbvib_mode_point, damping_ratio), 1, NULL},
  {"modal_amplitude", DOUBLE, offsetof(hbvib_mode_point, modal_amplitude), 1, NULL},
  {"energy", DOUBLE, offsetof(hbvib_mode_point, energy), 1, NULL},
  {"fundamental_share", DOUBLE, offsetof(hbvib_mode_point, fundamental_share), 1, NULL},
  {"friction_loss", DOUBLE, offsetof(hbvib_mode_point, friction_loss), 1, NULL},
  {"structural_loss", DOUBLE, offsetof(hbvib_mode_point, structural_loss), 1, NULL},
  {"energy_damping_ratio", DOUBLE, offsetof(hbvib_mode_point, energy_damping_ratio), 1, NULL},
  {"assurance", DOUBLE, offsetof(hbvib_mode_point, assurance), 1, NULL},
};
static hbvib_status mode_point_fill(void *s) { return hbvib_mode_point_init(s, sizeof(hbvib_mode_point)); }
static const Struct MODE_POINT_STRUCT = {"mode_point", sizeof(hbvib_mode_point), mode_point_fields, sizeof mode_point_fields / sizeof *mode_point_fields, mode_point_fill};

static const Field mode_info_fields[] = {
  {"multiple", INT32, offsetof(hbvib_mode_info, multiple), 1, NULL},
  {"mode_index", INT64, offsetof(hbvib_mode_info, mode_index), 1, NULL},
  {"multiplicity", INT64, offsetof(hbvib_mode_info, multiplicity), 1, NULL},
  {"reference_dof", INT64, offsetof(hbvib_mode_info, reference_dof), 1, NULL},
  {"engine_order", INT64, offsetof(hbvib_mode_info, engine_order), 1, NULL},
  {"amplitude_contact", INT64, offsetof(hbvib_mode_info, amplitude_contact), 1, NULL},
  {"omega", DOUBLE, offsetof(hbvib_mode_info, omega), 1, NULL},
  {"linear_up_to", DOUBLE, offsetof(hbvib_mode_info, linear_up_to), 1, NULL},
  {"slip_from", DOUBLE, offsetof(hbvib_mode_info, slip_from), 1, NULL},
  {"lift_off_from", DOUBLE, offsetof(hbvib_mode_info, lift_off_from), 1, NULL},
};
static hbvib_status mode_info_fill(void *s) { return hbvib_mode_info_init(s, sizeof(hbvib_mode_info)); }
static const Struct MODE_INFO_STRUCT = {"mode_info", sizeof(hbvib_mode_info), mode_info_fields, sizeof mode_info_fields / sizeof *mode_info_fields, mode_info_fill};

static const Field synthesis_options_fields[] = {
  {"model_damping", INT32, offsetof(hbvib_synthesis_options, model_damping), 1, NULL},
  {"force_factor", DOUBLE, offsetof(hbvib_synthesis_options, force_factor), 1, NULL},
  {"damping_ratio", DOUBLE, offsetof(hbvib_synthesis_options, damping_ratio), 1, NULL},
};
static hbvib_status synthesis_options_fill(void *s) { return hbvib_synthesis_options_init(s, sizeof(hbvib_synthesis_options)); }
static const Struct SYNTHESIS_OPTIONS_STRUCT = {"synthesis_options", sizeof(hbvib_synthesis_options), synthesis_options_fields, sizeof synthesis_options_fields / sizeof *synthesis_options_fields, synthesis_options_fill};

static const Field time_options_fields[] = {
  {"method", INT32, offsetof(hbvib_time_options, method), 1, NULL},
  {"omega", DOUBLE, offsetof(hbvib_time_options, omega), 1, NULL},
  {"harmonics", INT64, offsetof(hbvib_time_options, harmonics), 1, NULL},
  {"samples", INT64, offsetof(hbvib_time_options, samples), 1, NULL},
  {"tolerance", DOUBLE, offsetof(hbvib_time_options, tolerance), 1, NULL},
  {"max_periods", INT64, offsetof(hbvib_time_options, max_periods), 1, NULL},
  {"start", COMPLEXES, offsetof(hbvib_time_options, start), 1, NULL},
  {"start_len", INT64, offsetof(hbvib_time_options, start_len), 1, NULL},
  {"places", DOUBLES, offsetof(hbvib_time_options, places), 1, NULL},
  {"places_len", INT64, offsetof(hbvib_time_options, places_len), 1, NULL},
};
static hbvib_status time_options_fill(void *s) { return hbvib_time_options_init(s, sizeof(hbvib_time_options)); }
static const Struct TIME_OPTIONS_STRUCT = {"time_options", sizeof(hbvib_time_options), time_options_fields, sizeof time_options_fields / sizeof *time_options_fields, time_options_fill};

static const Field time_info_fields[] = {
  {"period", DOUBLE, offsetof(hbvib_time_info, period), 1, NULL},
  {"residual", DOUBLE, offsetof(hbvib_time_info, residual), 1, NULL},
  {"periods", INT64, offsetof(hbvib_time_info, periods), 1, NULL},
  {"events", INT64, offsetof(hbvib_time_info, events), 1, NULL},
};
static hbvib_status time_info_fill(void *s) { return hbvib_time_info_init(s, sizeof(hbvib_time_info)); }
static const Struct TIME_INFO_STRUCT = {"time_info", sizeof(hbvib_time_info), time_info_fields, sizeof time_info_fields / sizeof *time_info_fields, time_info_fill};

static const Field sweep_options_fields[] = {
  {"omega_start", DOUBLE, offsetof(hbvib_sweep_options, omega_start), 1, NULL},
  {"omega_stop", DOUBLE, offsetof(hbvib_sweep_options, omega_stop), 1, NULL},
  {"rate", DOUBLE, offsetof(hbvib_sweep_options, rate), 1, NULL},
  {"dof", INT64, offsetof(hbvib_sweep_options, dof), 1, NULL},
  {"tolerance", DOUBLE, offsetof(hbvib_sweep_options, tolerance), 1, NULL},
  {"max_periods", INT64, offsetof(hbvib_sweep_options, max_periods), 1, NULL},
  {"start", COMPLEXES, offsetof(hbvib_sweep_options, start), 1, NULL},
  {"start_len", INT64, offsetof(hbvib_sweep_options, start_len), 1, NULL},
};
static hbvib_status sweep_options_fill(void *s) { return hbvib_sweep_options_init(s, sizeof(hbvib_sweep_options)); }
static const Struct SWEEP_OPTIONS_STRUCT = {"sweep_options", sizeof(hbvib_sweep_options), sweep_options_fields, sizeof sweep_options_fields / sizeof *sweep_options_fields, sweep_options_fill};

static const Field sweep_info_fields[] = {
  {"largest", DOUBLE, offsetof(hbvib_sweep_info, largest), 1, NULL},
  {"largest_omega", DOUBLE, offsetof(hbvib_sweep_info, largest_omega), 1, NULL},
  {"largest_time", DOUBLE, offsetof(hbvib_sweep_info, largest_time), 1, NULL},
  {"events", INT64, offsetof(hbvib_sweep_info, events), 1, NULL},
};
static hbvib_status sweep_info_fill(void *s) { return hbvib_sweep_info_init(s, sizeof(hbvib_sweep_info)); }
static const Struct SWEEP_INFO_STRUCT = {"sweep_info", sizeof(hbvib_sweep_info), sweep_info_fields, sizeof sweep_info_fields / sizeof *sweep_info_fields, sweep_info_fill};

static const Field run_up_options_fields[] = {
  {"model_damping", INT32, offsetof(hbvib_run_up_options, model_damping), 1, NULL},
  {"omega_start", DOUBLE, offsetof(hbvib_run_up_options, omega_start), 1, NULL},
  {"omega_stop", DOUBLE, offsetof(hbvib_run_up_options, omega_stop), 1, NULL},
  {"rate", DOUBLE, offsetof(hbvib_run_up_options, rate), 1, NULL},
  {"dof", INT64, offsetof(hbvib_run_up_options, dof), 1, NULL},
  {"force_factor", DOUBLE, offsetof(hbvib_run_up_options, force_factor), 1, NULL},
  {"damping_ratio", DOUBLE, offsetof(hbvib_run_up_options, damping_ratio), 1, NULL},
  {"integrated_turns", INT64, offsetof(hbvib_run_up_options, integrated_turns), 1, NULL},
};
static hbvib_status run_up_options_fill(void *s) { return hbvib_run_up_options_init(s, sizeof(hbvib_run_up_options)); }
static const Struct RUN_UP_OPTIONS_STRUCT = {"run_up_options", sizeof(hbvib_run_up_options), run_up_options_fields, sizeof run_up_options_fields / sizeof *run_up_options_fields, run_up_options_fill};

static const Field run_up_info_fields[] = {
  {"largest", DOUBLE, offsetof(hbvib_run_up_info, largest), 1, NULL},
  {"largest_omega", DOUBLE, offsetof(hbvib_run_up_info, largest_omega), 1, NULL},
  {"largest_time", DOUBLE, offsetof(hbvib_run_up_info, largest_time), 1, NULL},
  {"error", DOUBLE, offsetof(hbvib_run_up_info, error), 1, NULL},
  {"without_memory", DOUBLE, offsetof(hbvib_run_up_info, without_memory), 1, NULL},
  {"steady", DOUBLE, offsetof(hbvib_run_up_info, steady), 1, NULL},
  {"slow_flow", DOUBLE, offsetof(hbvib_run_up_info, slow_flow), 1, NULL},
  {"integrated", INT64, offsetof(hbvib_run_up_info, integrated), 1, NULL},
};
static hbvib_status run_up_info_fill(void *s) { return hbvib_run_up_info_init(s, sizeof(hbvib_run_up_info)); }
static const Struct RUN_UP_INFO_STRUCT = {"run_up_info", sizeof(hbvib_run_up_info), run_up_info_fields, sizeof run_up_info_fields / sizeof *run_up_info_fields, run_up_info_fill};

static const Field mission_options_fields[] = {
  {"model_damping", INT32, offsetof(hbvib_mission_options, model_damping), 1, NULL},
  {"times", DOUBLES, offsetof(hbvib_mission_options, times), 1, NULL},
  {"speeds", DOUBLES, offsetof(hbvib_mission_options, speeds), 1, NULL},
  {"points_len", INT64, offsetof(hbvib_mission_options, points_len), 1, NULL},
  {"engine_order", DOUBLE, offsetof(hbvib_mission_options, engine_order), 1, NULL},
  {"dof", INT64, offsetof(hbvib_mission_options, dof), 1, NULL},
  {"edges", DOUBLES, offsetof(hbvib_mission_options, edges), 1, NULL},
  {"edges_len", INT64, offsetof(hbvib_mission_options, edges_len), 1, NULL},
  {"stresses", DOUBLES, offsetof(hbvib_mission_options, stresses), 1, NULL},
  {"stresses_len", INT64, offsetof(hbvib_mission_options, stresses_len), 1, NULL},
  {"woehler_stress", DOUBLE, offsetof(hbvib_mission_options, woehler_stress), 1, NULL},
  {"woehler_cycles", DOUBLE, offsetof(hbvib_mission_options, woehler_cycles), 1, NULL},
  {"woehler_slope", DOUBLE, offsetof(hbvib_mission_options, woehler_slope), 1, NULL},
  {"woehler_slope_below", DOUBLE, offsetof(hbvib_mission_options, woehler_slope_below), 1, NULL},
  {"force_factor", DOUBLE, offsetof(hbvib_mission_options, force_factor), 1, NULL},
  {"damping_ratio", DOUBLE, offsetof(hbvib_mission_options, damping_ratio), 1, NULL},
};
static hbvib_status mission_options_fill(void *s) { return hbvib_mission_options_init(s, sizeof(hbvib_mission_options)); }
static const Struct MISSION_OPTIONS_STRUCT = {"mission_options", sizeof(hbvib_mission_options), mission_options_fields, sizeof mission_options_fields / sizeof *mission_options_fields, mission_options_fill};

static const Field campbell_options_fields[] = {
  {"model_damping", INT32, offsetof(hbvib_campbell_options, model_damping), 1, NULL},
  {"engine_order", DOUBLE, offsetof(hbvib_campbell_options, engine_order), 1, NULL},
  {"acceleration", DOUBLE, offsetof(hbvib_campbell_options, acceleration), 1, NULL},
  {"damping_ratio", DOUBLE, offsetof(hbvib_campbell_options, damping_ratio), 1, NULL},
};
static hbvib_status campbell_options_fill(void *s) { return hbvib_campbell_options_init(s, sizeof(hbvib_campbell_options)); }
static const Struct CAMPBELL_OPTIONS_STRUCT = {"campbell_options", sizeof(hbvib_campbell_options), campbell_options_fields, sizeof campbell_options_fields / sizeof *campbell_options_fields, campbell_options_fill};

static const Field verify_options_fields[] = {
  {"method", INT32, offsetof(hbvib_verify_options, method), 1, NULL},
  {"tolerance", DOUBLE, offsetof(hbvib_verify_options, tolerance), 1, NULL},
  {"max_periods", INT64, offsetof(hbvib_verify_options, max_periods), 1, NULL},
  {"same_within", DOUBLE, offsetof(hbvib_verify_options, same_within), 1, NULL},
};
static hbvib_status verify_options_fill(void *s) { return hbvib_verify_options_init(s, sizeof(hbvib_verify_options)); }
static const Struct VERIFY_OPTIONS_STRUCT = {"verify_options", sizeof(hbvib_verify_options), verify_options_fields, sizeof verify_options_fields / sizeof *verify_options_fields, verify_options_fill};

static const Field verification_fields[] = {
  {"same_solution", INT32, offsetof(hbvib_verification, same_solution), 1, NULL},
  {"marched", INT32, offsetof(hbvib_verification, marched), 1, NULL},
  {"harmonic", INT64, offsetof(hbvib_verification, harmonic), 1, NULL},
  {"response", DOUBLE, offsetof(hbvib_verification, response), 2, NULL},
  {"response_error", DOUBLE, offsetof(hbvib_verification, response_error), 1, NULL},
  {"motion_error", DOUBLE, offsetof(hbvib_verification, motion_error), 1, NULL},
  {"above", DOUBLE, offsetof(hbvib_verification, above), 1, NULL},
  {"distance", DOUBLE, offsetof(hbvib_verification, distance), 1, NULL},
  {"peak", DOUBLE, offsetof(hbvib_verification, peak), 1, NULL},
  {"peak_error", DOUBLE, offsetof(hbvib_verification, peak_error), 1, NULL},
  {"residual", DOUBLE, offsetof(hbvib_verification, residual), 1, NULL},
  {"periods", INT64, offsetof(hbvib_verification, periods), 1, NULL},
  {"events", INT64, offsetof(hbvib_verification, events), 1, NULL},
  {"worst_response", INT64, offsetof(hbvib_verification, worst_response), 1, NULL},
  {"worst_response_error", DOUBLE, offsetof(hbvib_verification, worst_response_error), 1, NULL},
};
static hbvib_status verification_fill(void *s) { return hbvib_verification_init(s, sizeof(hbvib_verification)); }
static const Struct VERIFICATION_STRUCT = {"verification", sizeof(hbvib_verification), verification_fields, sizeof verification_fields / sizeof *verification_fields, verification_fill};

static const Field floquet_options_fields[] = {
  {"waves", INT32, offsetof(hbvib_floquet_options, waves), 1, NULL},
  {"refine", INT32, offsetof(hbvib_floquet_options, refine), 1, NULL},
  {"modes", INT32, offsetof(hbvib_floquet_options, modes), 1, NULL},
  {"tolerance", DOUBLE, offsetof(hbvib_floquet_options, tolerance), 1, NULL},
  {"max_periods", INT64, offsetof(hbvib_floquet_options, max_periods), 1, NULL},
};
static hbvib_status floquet_options_fill(void *s) { return hbvib_floquet_options_init(s, sizeof(hbvib_floquet_options)); }
static const Struct FLOQUET_OPTIONS_STRUCT = {"floquet_options", sizeof(hbvib_floquet_options), floquet_options_fields, sizeof floquet_options_fields / sizeof *floquet_options_fields, floquet_options_fill};

static const Field floquet_info_fields[] = {
  {"grazing", INT32, offsetof(hbvib_floquet_info, grazing), 1, NULL},
  {"omega", DOUBLE, offsetof(hbvib_floquet_info, omega), 1, NULL},
  {"radius", DOUBLE, offsetof(hbvib_floquet_info, radius), 1, NULL},
  {"count", INT64, offsetof(hbvib_floquet_info, count), 1, NULL},
  {"unstable", INT64, offsetof(hbvib_floquet_info, unstable), 1, NULL},
  {"neutral", INT64, offsetof(hbvib_floquet_info, neutral), 1, NULL},
  {"grazing_contact", INT64, offsetof(hbvib_floquet_info, grazing_contact), 1, NULL},
  {"orbit_change", DOUBLE, offsetof(hbvib_floquet_info, orbit_change), 1, NULL},
  {"residual", DOUBLE, offsetof(hbvib_floquet_info, residual), 1, NULL},
  {"modes", INT64, offsetof(hbvib_floquet_info, modes), 1, NULL},
  {"modes_change", DOUBLE, offsetof(hbvib_floquet_info, modes_change), 1, NULL},
  {"radius_error", DOUBLE, offsetof(hbvib_floquet_info, radius_error), 1, NULL},
};
static hbvib_status floquet_info_fill(void *s) { return hbvib_floquet_info_init(s, sizeof(hbvib_floquet_info)); }
static const Struct FLOQUET_INFO_STRUCT = {"floquet_info", sizeof(hbvib_floquet_info), floquet_info_fields, sizeof floquet_info_fields / sizeof *floquet_info_fields, floquet_info_fill};

static const Field kick_fields[] = {
  {"verified", INT32, offsetof(hbvib_kick, verified), 1, NULL},
  {"impulse", DOUBLE, offsetof(hbvib_kick, impulse), 1, NULL},
  {"returning", DOUBLE, offsetof(hbvib_kick, returning), 1, NULL},
  {"phase", DOUBLE, offsetof(hbvib_kick, phase), 1, NULL},
  {"estimate", DOUBLE, offsetof(hbvib_kick, estimate), 1, NULL},
  {"estimate_phase", DOUBLE, offsetof(hbvib_kick, estimate_phase), 1, NULL},
  {"velocity", DOUBLE, offsetof(hbvib_kick, velocity), 1, NULL},
  {"multiplier", DOUBLE, offsetof(hbvib_kick, multiplier), 1, NULL},
};
static hbvib_status kick_fill(void *s) { return hbvib_kick_init(s, sizeof(hbvib_kick)); }
static const Struct KICK_STRUCT = {"kick", sizeof(hbvib_kick), kick_fields, sizeof kick_fields / sizeof *kick_fields, kick_fill};

static const Field parameter_fields[] = {
  {"kind", INT32, offsetof(hbvib_parameter, kind), 1, NULL},
  {"contact", INT64, offsetof(hbvib_parameter, contact), 1, NULL},
  {"direction", STRUCTS, offsetof(hbvib_parameter, direction), 1, &MATRIX_STRUCT},
  {"scaling", INT32, offsetof(hbvib_parameter, scaling), 1, NULL},
};
static hbvib_status parameter_fill(void *s) { return hbvib_parameter_init(s, sizeof(hbvib_parameter)); }
static const Struct PARAMETER_STRUCT = {"parameter", sizeof(hbvib_parameter), parameter_fields, sizeof parameter_fields / sizeof *parameter_fields, parameter_fill};

static const Field parameter_options_fields[] = {
  {"follow", INT32, offsetof(hbvib_parameter_options, follow), 1, NULL},
  {"parameter", STRUCTS, offsetof(hbvib_parameter_options, parameter), 1, &PARAMETER_STRUCT},
  {"start", DOUBLE, offsetof(hbvib_parameter_options, start), 1, NULL},
  {"stop", DOUBLE, offsetof(hbvib_parameter_options, stop), 1, NULL},
  {"omega", DOUBLE, offsetof(hbvib_parameter_options, omega), 1, NULL},
  {"at", DOUBLES, offsetof(hbvib_parameter_options, at), 1, NULL},
  {"at_len", INT64, offsetof(hbvib_parameter_options, at_len), 1, NULL},
  {"log10_start", DOUBLE, offsetof(hbvib_parameter_options, log10_start), 1, NULL},
  {"log10_stop", DOUBLE, offsetof(hbvib_parameter_options, log10_stop), 1, NULL},
  {"response", STRUCTS, offsetof(hbvib_parameter_options, response), 1, &RESPONSE_STRUCT},
};
static hbvib_status parameter_options_fill(void *s) { return hbvib_parameter_options_init(s, sizeof(hbvib_parameter_options)); }
static const Struct PARAMETER_OPTIONS_STRUCT = {"parameter_options", sizeof(hbvib_parameter_options), parameter_options_fields, sizeof parameter_options_fields / sizeof *parameter_options_fields, parameter_options_fill};

static const Field batch_options_fields[] = {
  {"threads", INT32, offsetof(hbvib_batch_options, threads), 1, NULL},
  {"omega_start", DOUBLE, offsetof(hbvib_batch_options, omega_start), 1, NULL},
  {"omega_stop", DOUBLE, offsetof(hbvib_batch_options, omega_stop), 1, NULL},
  {"keep", INT32, offsetof(hbvib_batch_options, keep), 1, NULL},
  {"responses", STRUCTS, offsetof(hbvib_batch_options, responses), 1, &RESPONSE_STRUCT},
  {"responses_len", INT64, offsetof(hbvib_batch_options, responses_len), 1, NULL},
};
static hbvib_status batch_options_fill(void *s) { return hbvib_batch_options_init(s, sizeof(hbvib_batch_options)); }
static const Struct BATCH_OPTIONS_STRUCT = {"batch_options", sizeof(hbvib_batch_options), batch_options_fields, sizeof batch_options_fields / sizeof *batch_options_fields, batch_options_fill};

static const Field wheel_info_fields[] = {
  {"blade", INT64, offsetof(hbvib_wheel_info, blade), 1, NULL},
  {"largest", DOUBLE, offsetof(hbvib_wheel_info, largest), 1, NULL},
  {"tuned", DOUBLE, offsetof(hbvib_wheel_info, tuned), 1, NULL},
  {"tuned_omega", DOUBLE, offsetof(hbvib_wheel_info, tuned_omega), 1, NULL},
  {"amplification", DOUBLE, offsetof(hbvib_wheel_info, amplification), 1, NULL},
  {"beyond", INT64, offsetof(hbvib_wheel_info, beyond), 1, NULL},
  {"end_amplitude", DOUBLE, offsetof(hbvib_wheel_info, end_amplitude), 1, NULL},
  {"end_omega", DOUBLE, offsetof(hbvib_wheel_info, end_omega), 1, NULL},
};
static hbvib_status wheel_info_fill(void *s) { return hbvib_wheel_info_init(s, sizeof(hbvib_wheel_info)); }
static const Struct WHEEL_INFO_STRUCT = {"wheel_info", sizeof(hbvib_wheel_info), wheel_info_fields, sizeof wheel_info_fields / sizeof *wheel_info_fields, wheel_info_fill};

static const Field band_options_fields[] = {
  {"of", INT32, offsetof(hbvib_band_options, of), 1, NULL},
  {"contacts", INT64S, offsetof(hbvib_band_options, contacts), 1, NULL},
  {"contacts_len", INT64, offsetof(hbvib_band_options, contacts_len), 1, NULL},
  {"starts", INT64, offsetof(hbvib_band_options, starts), 1, NULL},
};
static hbvib_status band_options_fill(void *s) { return hbvib_band_options_init(s, sizeof(hbvib_band_options)); }
static const Struct BAND_OPTIONS_STRUCT = {"band_options", sizeof(hbvib_band_options), band_options_fields, sizeof band_options_fields / sizeof *band_options_fields, band_options_fill};

static const Field band_info_fields[] = {
  {"complete", INT32, offsetof(hbvib_band_info, complete), 1, NULL},
  {"sliders", INT64, offsetof(hbvib_band_info, sliders), 1, NULL},
  {"states", INT64, offsetof(hbvib_band_info, states), 1, NULL},
  {"solved", INT64, offsetof(hbvib_band_info, solved), 1, NULL},
  {"lower", DOUBLE, offsetof(hbvib_band_info, lower), 1, NULL},
  {"upper", DOUBLE, offsetof(hbvib_band_info, upper), 1, NULL},
  {"lower_omega", DOUBLE, offsetof(hbvib_band_info, lower_omega), 1, NULL},
  {"upper_omega", DOUBLE, offsetof(hbvib_band_info, upper_omega), 1, NULL},
  {"lower_gain", DOUBLE, offsetof(hbvib_band_info, lower_gain), 1, NULL},
  {"upper_gain", DOUBLE, offsetof(hbvib_band_info, upper_gain), 1, NULL},
  {"lower_at_limit", INT64, offsetof(hbvib_band_info, lower_at_limit), 1, NULL},
  {"upper_at_limit", INT64, offsetof(hbvib_band_info, upper_at_limit), 1, NULL},
  {"lower_error", DOUBLE, offsetof(hbvib_band_info, lower_error), 1, NULL},
  {"upper_error", DOUBLE, offsetof(hbvib_band_info, upper_error), 1, NULL},
};
static hbvib_status band_info_fill(void *s) { return hbvib_band_info_init(s, sizeof(hbvib_band_info)); }
static const Struct BAND_INFO_STRUCT = {"band_info", sizeof(hbvib_band_info), band_info_fields, sizeof band_info_fields / sizeof *band_info_fields, band_info_fill};

static const Field life_options_fields[] = {
  {"follow", INT32, offsetof(hbvib_life_options, follow), 1, NULL},
  {"contacts", INT64S, offsetof(hbvib_life_options, contacts), 1, NULL},
  {"rates", DOUBLES, offsetof(hbvib_life_options, rates), 1, NULL},
  {"areas", DOUBLES, offsetof(hbvib_life_options, areas), 1, NULL},
  {"contacts_len", INT64, offsetof(hbvib_life_options, contacts_len), 1, NULL},
  {"stiffness", DOUBLES, offsetof(hbvib_life_options, stiffness), 1, NULL},
  {"worn", DOUBLES, offsetof(hbvib_life_options, worn), 1, NULL},
  {"duty_omega", DOUBLES, offsetof(hbvib_life_options, duty_omega), 1, NULL},
  {"duty_force", DOUBLES, offsetof(hbvib_life_options, duty_force), 1, NULL},
  {"duty_share", DOUBLES, offsetof(hbvib_life_options, duty_share), 1, NULL},
  {"duties_len", INT64, offsetof(hbvib_life_options, duties_len), 1, NULL},
  {"omega_start", DOUBLE, offsetof(hbvib_life_options, omega_start), 1, NULL},
  {"omega_stop", DOUBLE, offsetof(hbvib_life_options, omega_stop), 1, NULL},
  {"tolerance", DOUBLE, offsetof(hbvib_life_options, tolerance), 1, NULL},
  {"limit", DOUBLE, offsetof(hbvib_life_options, limit), 1, NULL},
  {"most_steps", INT64, offsetof(hbvib_life_options, most_steps), 1, NULL},
};
static hbvib_status life_options_fill(void *s) { return hbvib_life_options_init(s, sizeof(hbvib_life_options)); }
static const Struct LIFE_OPTIONS_STRUCT = {"life_options", sizeof(hbvib_life_options), life_options_fields, sizeof life_options_fields / sizeof *life_options_fields, life_options_fill};

static const Field life_info_fields[] = {
  {"steps", INT64, offsetof(hbvib_life_info, steps), 1, NULL},
  {"solutions", INT64, offsetof(hbvib_life_info, solutions), 1, NULL},
  {"points", INT64, offsetof(hbvib_life_info, points), 1, NULL},
  {"reached", DOUBLE, offsetof(hbvib_life_info, reached), 1, NULL},
  {"largest", DOUBLE, offsetof(hbvib_life_info, largest), 1, NULL},
  {"largest_at", DOUBLE, offsetof(hbvib_life_info, largest_at), 1, NULL},
  {"amplitude_new", DOUBLE, offsetof(hbvib_life_info, amplitude_new), 1, NULL},
  {"amplitude_worn", DOUBLE, offsetof(hbvib_life_info, amplitude_worn), 1, NULL},
};
static hbvib_status life_info_fill(void *s) { return hbvib_life_info_init(s, sizeof(hbvib_life_info)); }
static const Struct LIFE_INFO_STRUCT = {"life_info", sizeof(hbvib_life_info), life_info_fields, sizeof life_info_fields / sizeof *life_info_fields, life_info_fill};

static const Field best_load_fields[] = {
  {"factor", DOUBLE, offsetof(hbvib_best_load, factor), 1, NULL},
  {"amplitude", DOUBLE, offsetof(hbvib_best_load, amplitude), 1, NULL},
  {"amplitude_new", DOUBLE, offsetof(hbvib_best_load, amplitude_new), 1, NULL},
  {"amplitude_worn", DOUBLE, offsetof(hbvib_best_load, amplitude_worn), 1, NULL},
  {"lives", INT64, offsetof(hbvib_best_load, lives), 1, NULL},
};
static hbvib_status best_load_fill(void *s) { return hbvib_best_load_init(s, sizeof(hbvib_best_load)); }
static const Struct BEST_LOAD_STRUCT = {"best_load", sizeof(hbvib_best_load), best_load_fields, sizeof best_load_fields / sizeof *best_load_fields, best_load_fill};

static const Field data_fields[] = {
  {"kind", INT32, offsetof(hbvib_data, kind), 1, NULL},
  {"force_factor", DOUBLE, offsetof(hbvib_data, force_factor), 1, NULL},
  {"response", STRUCTS, offsetof(hbvib_data, response), 1, &RESPONSE_STRUCT},
  {"mode", INT64, offsetof(hbvib_data, mode), 1, NULL},
  {"omega_start", DOUBLE, offsetof(hbvib_data, omega_start), 1, NULL},
  {"omega_stop", DOUBLE, offsetof(hbvib_data, omega_stop), 1, NULL},
  {"n", INT64, offsetof(hbvib_data, n), 1, NULL},
  {"x", DOUBLES, offsetof(hbvib_data, x), 1, NULL},
  {"value", DOUBLES, offsetof(hbvib_data, value), 1, NULL},
  {"sigma", DOUBLES, offsetof(hbvib_data, sigma), 1, NULL},
  {"second_sigma", DOUBLES, offsetof(hbvib_data, second_sigma), 1, NULL},
};
static hbvib_status data_fill(void *s) { return hbvib_data_init(s, sizeof(hbvib_data)); }
static const Struct DATA_STRUCT = {"data", sizeof(hbvib_data), data_fields, sizeof data_fields / sizeof *data_fields, data_fill};

static const Field unknown_fields[] = {
  {"scale", INT32, offsetof(hbvib_unknown, scale), 1, NULL},
  {"start", DOUBLE, offsetof(hbvib_unknown, start), 1, NULL},
  {"lower", DOUBLE, offsetof(hbvib_unknown, lower), 1, NULL},
  {"upper", DOUBLE, offsetof(hbvib_unknown, upper), 1, NULL},
  {"prior_mean", DOUBLE, offsetof(hbvib_unknown, prior_mean), 1, NULL},
  {"prior_sigma", DOUBLE, offsetof(hbvib_unknown, prior_sigma), 1, NULL},
  {"tied_to", INT64, offsetof(hbvib_unknown, tied_to), 1, NULL},
  {"has_start", INT32, offsetof(hbvib_unknown, has_start), 1, NULL},
  {"has_lower", INT32, offsetof(hbvib_unknown, has_lower), 1, NULL},
  {"has_upper", INT32, offsetof(hbvib_unknown, has_upper), 1, NULL},
  {"data_set", INT64, offsetof(hbvib_unknown, data_set), 1, NULL},
};
static hbvib_status unknown_fill(void *s) { return hbvib_unknown_init(s, sizeof(hbvib_unknown)); }
static const Struct UNKNOWN_STRUCT = {"unknown", sizeof(hbvib_unknown), unknown_fields, sizeof unknown_fields / sizeof *unknown_fields, unknown_fill};

static const Field fit_options_fields[] = {
  {"scale_covariance", INT32, offsetof(hbvib_fit_options, scale_covariance), 1, NULL},
  {"huber", DOUBLE, offsetof(hbvib_fit_options, huber), 1, NULL},
  {"starts", INT64, offsetof(hbvib_fit_options, starts), 1, NULL},
  {"max_iterations", INT64, offsetof(hbvib_fit_options, max_iterations), 1, NULL},
  {"step", DOUBLE, offsetof(hbvib_fit_options, step), 1, NULL},
};
static hbvib_status fit_options_fill(void *s) { return hbvib_fit_options_init(s, sizeof(hbvib_fit_options)); }
static const Struct FIT_OPTIONS_STRUCT = {"fit_options", sizeof(hbvib_fit_options), fit_options_fields, sizeof fit_options_fields / sizeof *fit_options_fields, fit_options_fill};

static const Field fit_info_fields[] = {
  {"suspicion", INT32, offsetof(hbvib_fit_info, suspicion), 1, NULL},
  {"chi2", DOUBLE, offsetof(hbvib_fit_info, chi2), 1, NULL},
  {"loss", DOUBLE, offsetof(hbvib_fit_info, loss), 1, NULL},
  {"degrees_of_freedom", INT64, offsetof(hbvib_fit_info, degrees_of_freedom), 1, NULL},
  {"data", INT64, offsetof(hbvib_fit_info, data), 1, NULL},
  {"free", INT64, offsetof(hbvib_fit_info, free), 1, NULL},
  {"iterations", INT64, offsetof(hbvib_fit_info, iterations), 1, NULL},
  {"starts", INT64, offsetof(hbvib_fit_info, starts), 1, NULL},
  {"at_bound", INT64, offsetof(hbvib_fit_info, at_bound), 1, NULL},
  {"slipping", INT64, offsetof(hbvib_fit_info, slipping), 1, NULL},
  {"aic", DOUBLE, offsetof(hbvib_fit_info, aic), 1, NULL},
  {"bic", DOUBLE, offsetof(hbvib_fit_info, bic), 1, NULL},
  {"condition", DOUBLE, offsetof(hbvib_fit_info, condition), 1, NULL},
  {"harmonic_error", DOUBLE, offsetof(hbvib_fit_info, harmonic_error), 1, NULL},
  {"suspected_factor", DOUBLE, offsetof(hbvib_fit_info, suspected_factor), 1, NULL},
};
static hbvib_status fit_info_fill(void *s) { return hbvib_fit_info_init(s, sizeof(hbvib_fit_info)); }
static const Struct FIT_INFO_STRUCT = {"fit_info", sizeof(hbvib_fit_info), fit_info_fields, sizeof fit_info_fields / sizeof *fit_info_fields, fit_info_fill};

static const Field fit_profile_info_fields[] = {
  {"best", DOUBLE, offsetof(hbvib_fit_profile_info, best), 1, NULL},
  {"unit", DOUBLE, offsetof(hbvib_fit_profile_info, unit), 1, NULL},
  {"lower", DOUBLE, offsetof(hbvib_fit_profile_info, lower), 1, NULL},
  {"upper", DOUBLE, offsetof(hbvib_fit_profile_info, upper), 1, NULL},
  {"found", INT64, offsetof(hbvib_fit_profile_info, found), 1, NULL},
};
static hbvib_status fit_profile_info_fill(void *s) { return hbvib_fit_profile_info_init(s, sizeof(hbvib_fit_profile_info)); }
static const Struct FIT_PROFILE_INFO_STRUCT = {"fit_profile_info", sizeof(hbvib_fit_profile_info), fit_profile_info_fields, sizeof fit_profile_info_fields / sizeof *fit_profile_info_fields, fit_profile_info_fill};

static void call_version(Call *a) {
  double result_ = (double)hbvib_version();
  give_count(a, result_);
}

static void call_version_string(Call *a) {
  give_text(a, hbvib_version_string());
}

static void call_status_name(Call *a) {
  hbvib_status status_ = (int32_t)whole32(a, "status");
  give_text(a, hbvib_status_name(status_));
}

static void call_last_error(Call *a) {
  give_text(a, hbvib_last_error());
}

static void call_last_error_argument(Call *a) {
  double result_ = (double)hbvib_last_error_argument();
  give_count(a, result_);
}

static void call_model_new(Call *a) {
  int64_t ndof_ = whole(a, "ndof");
  hbvib_model *out_ = NULL;
  hbvib_status status_ = hbvib_model_new(ndof_, &out_);
  give_model(a, out_);
  finish(a, status_);
}

static void call_model_clone(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  hbvib_model *out_ = NULL;
  hbvib_status status_ = hbvib_model_clone(model_, &out_);
  give_model(a, out_);
  finish(a, status_);
}

static void call_model_free(Call *a) {
  hbvib_model *model_ = handle(a, "model");
  hbvib_status status_ = hbvib_model_free(model_);
  finish(a, status_);
}

static void call_model_dofs(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  double result_ = (double)hbvib_model_dofs(model_);
  give_count(a, result_);
}

static void call_model_sectors(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  double result_ = (double)hbvib_model_sectors(model_);
  give_count(a, result_);
}

static void call_model_contacts(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  double result_ = (double)hbvib_model_contacts(model_);
  give_count(a, result_);
}

static void call_model_set_matrix(Call *a) {
  hbvib_model *model_ = handle(a, "model");
  int32_t which_ = (int32_t)whole32(a, "which");
  const hbvib_matrix *a_ = structs(a, "a", &MATRIX_STRUCT);
  hbvib_status status_ = hbvib_model_set_matrix(model_, which_, a_);
  finish(a, status_);
}

static void call_model_fix(Call *a) {
  hbvib_model *model_ = handle(a, "model");
  int64_t n_ = whole(a, "n");
  const int64_t *dofs_ = wholes(a, "dofs");
  hbvib_status status_ = hbvib_model_fix(model_, n_, dofs_);
  finish(a, status_);
}

static void call_model_set_rayleigh(Call *a) {
  hbvib_model *model_ = handle(a, "model");
  double alpha_mass_ = real(a, "alpha_mass");
  double beta_stiffness_ = real(a, "beta_stiffness");
  hbvib_status status_ = hbvib_model_set_rayleigh(model_, alpha_mass_, beta_stiffness_);
  finish(a, status_);
}

static void call_model_add_springs(Call *a) {
  hbvib_model *model_ = handle(a, "model");
  int64_t n_ = whole(a, "n");
  const int64_t *dof_a_ = wholes(a, "dof_a");
  const int64_t *dof_b_ = wholes(a, "dof_b");
  const int64_t *sector_offset_ = wholes(a, "sector_offset");
  const double *stiffness_ = reals(a, "stiffness");
  hbvib_status status_ = hbvib_model_add_springs(model_, n_, dof_a_, dof_b_, sector_offset_, stiffness_);
  finish(a, status_);
}

static void call_model_add_force(Call *a) {
  hbvib_model *model_ = handle(a, "model");
  int64_t dof_ = whole(a, "dof");
  int64_t harmonic_ = whole(a, "harmonic");
  double re_ = real(a, "re");
  double im_ = real(a, "im");
  hbvib_status status_ = hbvib_model_add_force(model_, dof_, harmonic_, re_, im_);
  finish(a, status_);
}

static void call_model_clear_forces(Call *a) {
  hbvib_model *model_ = handle(a, "model");
  hbvib_status status_ = hbvib_model_clear_forces(model_);
  finish(a, status_);
}

static void call_model_set_loss_factor(Call *a) {
  hbvib_model *model_ = handle(a, "model");
  double loss_factor_ = real(a, "loss_factor");
  hbvib_status status_ = hbvib_model_set_loss_factor(model_, loss_factor_);
  finish(a, status_);
}

static void call_model_set_modal_damping(Call *a) {
  hbvib_model *model_ = handle(a, "model");
  int64_t n_ = whole(a, "n");
  const double *ratios_ = reals(a, "ratios");
  hbvib_status status_ = hbvib_model_set_modal_damping(model_, n_, ratios_);
  finish(a, status_);
}

static void call_model_set_speed(Call *a) {
  hbvib_model *model_ = handle(a, "model");
  double speed_ = real(a, "speed");
  hbvib_status status_ = hbvib_model_set_speed(model_, speed_);
  finish(a, status_);
}

static void call_model_set_speed_per_omega(Call *a) {
  hbvib_model *model_ = handle(a, "model");
  double per_omega_ = real(a, "per_omega");
  hbvib_status status_ = hbvib_model_set_speed_per_omega(model_, per_omega_);
  finish(a, status_);
}

static void call_model_set_preload_at_speed(Call *a) {
  hbvib_model *model_ = handle(a, "model");
  int64_t id_ = whole(a, "id");
  double preload_ = real(a, "preload");
  double per_speed2_ = real(a, "per_speed2");
  hbvib_status status_ = hbvib_model_set_preload_at_speed(model_, id_, preload_, per_speed2_);
  finish(a, status_);
}

static void call_model_add_centrifugal(Call *a) {
  hbvib_model *model_ = handle(a, "model");
  int64_t dof_ = whole(a, "dof");
  double mass_radius_ = real(a, "mass_radius");
  hbvib_status status_ = hbvib_model_add_centrifugal(model_, dof_, mass_radius_);
  finish(a, status_);
}

static void call_model_add_unbalance(Call *a) {
  hbvib_model *model_ = handle(a, "model");
  int64_t dof_x_ = whole(a, "dof_x");
  int64_t dof_y_ = whole(a, "dof_y");
  double m_e_ = real(a, "m_e");
  double phase_ = real(a, "phase");
  hbvib_status status_ = hbvib_model_add_unbalance(model_, dof_x_, dof_y_, m_e_, phase_);
  finish(a, status_);
}

static void call_model_wave(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  int64_t engine_order_ = 0;
  hbvib_status status_ = hbvib_model_wave(model_, &engine_order_);
  give_number(a, (double)engine_order_);
  finish(a, status_);
}

static void call_model_matrix(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  int32_t which_ = (int32_t)whole32(a, "which");
  int32_t block_ = (int32_t)whole32(a, "block");
  int64_t capacity_ = whole(a, "capacity");
  int64_t row_n = room(a, "row");
  int64_t *row_ = array(row_n, 1 * sizeof(int64_t));
  int64_t column_n = room(a, "column");
  int64_t *column_ = array(column_n, 1 * sizeof(int64_t));
  int64_t value_n = room(a, "value");
  double *value_ = array(value_n, 2 * sizeof(double));
  int64_t count_ = 0;
  hbvib_status status_ = hbvib_model_matrix(model_, which_, block_, capacity_, row_, column_, value_, &count_);
  give_wholes(a, row_, row_n);
  give_wholes(a, column_, column_n);
  give_complexes(a, value_, value_n);
  give_number(a, (double)count_);
  finish(a, status_);
}

static void call_model_springs(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  int64_t capacity_ = whole(a, "capacity");
  int64_t dof_a_n = room(a, "dof_a");
  int64_t *dof_a_ = array(dof_a_n, 1 * sizeof(int64_t));
  int64_t dof_b_n = room(a, "dof_b");
  int64_t *dof_b_ = array(dof_b_n, 1 * sizeof(int64_t));
  int64_t sector_offset_n = room(a, "sector_offset");
  int64_t *sector_offset_ = array(sector_offset_n, 1 * sizeof(int64_t));
  int64_t stiffness_n = room(a, "stiffness");
  double *stiffness_ = array(stiffness_n, 1 * sizeof(double));
  int64_t count_ = 0;
  hbvib_status status_ = hbvib_model_springs(model_, capacity_, dof_a_, dof_b_, sector_offset_, stiffness_, &count_);
  give_wholes(a, dof_a_, dof_a_n);
  give_wholes(a, dof_b_, dof_b_n);
  give_wholes(a, sector_offset_, sector_offset_n);
  give_reals(a, stiffness_, stiffness_n);
  give_number(a, (double)count_);
  finish(a, status_);
}

static void call_model_forces(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  int64_t capacity_ = whole(a, "capacity");
  int64_t dof_n = room(a, "dof");
  int64_t *dof_ = array(dof_n, 1 * sizeof(int64_t));
  int64_t harmonic_n = room(a, "harmonic");
  int64_t *harmonic_ = array(harmonic_n, 1 * sizeof(int64_t));
  int64_t force_n = room(a, "force");
  double *force_ = array(force_n, 2 * sizeof(double));
  int64_t unbalance_n = room(a, "unbalance");
  int64_t *unbalance_ = array(unbalance_n, 1 * sizeof(int64_t));
  int64_t count_ = 0;
  hbvib_status status_ = hbvib_model_forces(model_, capacity_, dof_, harmonic_, force_, unbalance_, &count_);
  give_wholes(a, dof_, dof_n);
  give_wholes(a, harmonic_, harmonic_n);
  give_complexes(a, force_, force_n);
  give_wholes(a, unbalance_, unbalance_n);
  give_number(a, (double)count_);
  finish(a, status_);
}

static void call_model_save(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  int64_t capacity_ = whole(a, "capacity");
  int64_t bytes_n = room(a, "bytes");
  uint8_t *bytes_ = array(bytes_n, 1 * sizeof(uint8_t));
  int64_t size_ = 0;
  hbvib_status status_ = hbvib_model_save(model_, capacity_, bytes_, &size_);
  give_bytes(a, bytes_, bytes_n);
  give_number(a, (double)size_);
  finish(a, status_);
}

static void call_model_load(Call *a) {
  int64_t length_ = whole(a, "length");
  const void *bytes_ = bytes(a, "bytes");
  hbvib_model *out_ = NULL;
  hbvib_status status_ = hbvib_model_load(length_, bytes_, &out_);
  give_model(a, out_);
  finish(a, status_);
}

static void call_cyclic_new(Call *a) {
  int64_t ndof_sector_ = whole(a, "ndof_sector");
  int64_t sectors_ = whole(a, "sectors");
  hbvib_model *out_ = NULL;
  hbvib_status status_ = hbvib_cyclic_new(ndof_sector_, sectors_, &out_);
  give_model(a, out_);
  finish(a, status_);
}

static void call_cyclic_set_coupling(Call *a) {
  hbvib_model *model_ = handle(a, "model");
  int32_t which_ = (int32_t)whole32(a, "which");
  const hbvib_matrix *to_next_ = structs(a, "to_next", &MATRIX_STRUCT);
  hbvib_status status_ = hbvib_cyclic_set_coupling(model_, which_, to_next_);
  finish(a, status_);
}

static void call_cyclic_set_coupling_previous(Call *a) {
  hbvib_model *model_ = handle(a, "model");
  int32_t which_ = (int32_t)whole32(a, "which");
  const hbvib_matrix *to_previous_ = structs(a, "to_previous", &MATRIX_STRUCT);
  hbvib_status status_ = hbvib_cyclic_set_coupling_previous(model_, which_, to_previous_);
  finish(a, status_);
}

static void call_cyclic_set_diameter(Call *a) {
  hbvib_model *model_ = handle(a, "model");
  int32_t which_ = (int32_t)whole32(a, "which");
  int64_t diameter_ = whole(a, "diameter");
  const hbvib_matrix *a_ = structs(a, "a", &MATRIX_STRUCT);
  hbvib_status status_ = hbvib_cyclic_set_diameter(model_, which_, diameter_, a_);
  finish(a, status_);
}

static void call_cyclic_signed_diameter(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  int64_t waves_ = whole(a, "waves");
  int64_t diameter_ = 0;
  hbvib_status status_ = hbvib_cyclic_signed_diameter(model_, waves_, &diameter_);
  give_number(a, (double)diameter_);
  finish(a, status_);
}

static void call_cyclic_set_wave(Call *a) {
  hbvib_model *model_ = handle(a, "model");
  int64_t engine_order_ = whole(a, "engine_order");
  hbvib_status status_ = hbvib_cyclic_set_wave(model_, engine_order_);
  finish(a, status_);
}

static void call_cyclic_set_aero(Call *a) {
  hbvib_model *model_ = handle(a, "model");
  int64_t n_dofs_ = whole(a, "n_dofs");
  const int64_t *dofs_ = wholes(a, "dofs");
  int64_t n_offsets_ = whole(a, "n_offsets");
  const double *coefficients_ = complexes(a, "coefficients");
  const int64_t *offsets_ = wholes(a, "offsets");
  int32_t form_ = (int32_t)whole32(a, "form");
  hbvib_status status_ = hbvib_cyclic_set_aero(model_, n_dofs_, dofs_, n_offsets_, coefficients_, offsets_, form_);
  finish(a, status_);
}

static void call_cyclic_aero(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  int32_t form_ = (int32_t)whole32(a, "form");
  int64_t capacity_ = whole(a, "capacity");
  int64_t dof_force_n = room(a, "dof_force");
  int64_t *dof_force_ = array(dof_force_n, 1 * sizeof(int64_t));
  int64_t dof_motion_n = room(a, "dof_motion");
  int64_t *dof_motion_ = array(dof_motion_n, 1 * sizeof(int64_t));
  int64_t offset_n = room(a, "offset");
  int64_t *offset_ = array(offset_n, 1 * sizeof(int64_t));
  int64_t coefficient_n = room(a, "coefficient");
  double *coefficient_ = array(coefficient_n, 2 * sizeof(double));
  int64_t count_ = 0;
  hbvib_status status_ = hbvib_cyclic_aero(model_, form_, capacity_, dof_force_, dof_motion_, offset_, coefficient_, &count_);
  give_wholes(a, dof_force_, dof_force_n);
  give_wholes(a, dof_motion_, dof_motion_n);
  give_wholes(a, offset_, offset_n);
  give_complexes(a, coefficient_, coefficient_n);
  give_number(a, (double)count_);
  finish(a, status_);
}

static void call_cyclic_from_sector(Call *a) {
  const hbvib_sector *sector_ = structs(a, "sector", &SECTOR_STRUCT);
  hbvib_model *out_ = NULL;
  hbvib_status status_ = hbvib_cyclic_from_sector(sector_, &out_);
  give_model(a, out_);
  finish(a, status_);
}

static void call_wheel_new(Call *a) {
  const hbvib_model *cyclic_ = handle(a, "cyclic");
  hbvib_model *out_ = NULL;
  hbvib_status status_ = hbvib_wheel_new(cyclic_, &out_);
  give_model(a, out_);
  finish(a, status_);
}

static void call_wheel_mistune(Call *a) {
  hbvib_model *wheel_ = handle(a, "wheel");
  const hbvib_model *cyclic_ = handle(a, "cyclic");
  int32_t kind_ = (int32_t)whole32(a, "kind");
  int64_t n_dofs_ = whole(a, "n_dofs");
  const int64_t *dofs_ = wholes(a, "dofs");
  const hbvib_matrix *direction_ = structs(a, "direction", &MATRIX_STRUCT);
  int64_t contact_ = whole(a, "contact");
  int64_t sectors_ = whole(a, "sectors");
  const double *delta_ = reals(a, "delta");
  hbvib_status status_ = hbvib_wheel_mistune(wheel_, cyclic_, kind_, n_dofs_, dofs_, direction_, contact_, sectors_, delta_);
  finish(a, status_);
}

static void call_model_add_contact(Call *a) {
  hbvib_model *model_ = handle(a, "model");
  const hbvib_contact *c_ = structs(a, "c", &CONTACT_STRUCT);
  int64_t id_ = 0;
  hbvib_status status_ = hbvib_model_add_contact(model_, c_, &id_);
  give_number(a, (double)id_);
  finish(a, status_);
}

static void call_model_set_preload(Call *a) {
  hbvib_model *model_ = handle(a, "model");
  int64_t id_ = whole(a, "id");
  double preload_ = real(a, "preload");
  hbvib_status status_ = hbvib_model_set_preload(model_, id_, preload_);
  finish(a, status_);
}

static void call_model_set_slider(Call *a) {
  hbvib_model *model_ = handle(a, "model");
  int64_t id_ = whole(a, "id");
  int64_t direction_ = whole(a, "direction");
  double place_ = real(a, "place");
  hbvib_status status_ = hbvib_model_set_slider(model_, id_, direction_, place_);
  finish(a, status_);
}

static void call_model_add_jenkins(Call *a) {
  hbvib_model *model_ = handle(a, "model");
  int64_t n_ = whole(a, "n");
  const int64_t *dof_a_ = wholes(a, "dof_a");
  const int64_t *dof_b_ = wholes(a, "dof_b");
  const int64_t *sector_offset_ = wholes(a, "sector_offset");
  const double *kt_ = reals(a, "kt");
  const double *mu_ = reals(a, "mu");
  const double *preload_ = reals(a, "preload");
  int64_t first_id_ = 0;
  hbvib_status status_ = hbvib_model_add_jenkins(model_, n_, dof_a_, dof_b_, sector_offset_, kt_, mu_, preload_, &first_id_);
  give_number(a, (double)first_id_);
  finish(a, status_);
}

static void call_model_add_iwan(Call *a) {
  hbvib_model *model_ = handle(a, "model");
  int64_t dof_a_ = whole(a, "dof_a");
  int64_t dof_b_ = whole(a, "dof_b");
  int64_t sector_offset_ = whole(a, "sector_offset");
  double slip_force_ = real(a, "slip_force");
  double stiffness_ = real(a, "stiffness");
  double chi_ = real(a, "chi");
  double beta_ = real(a, "beta");
  int64_t elements_ = whole(a, "elements");
  int64_t first_id_ = 0;
  hbvib_status status_ = hbvib_model_add_iwan(model_, dof_a_, dof_b_, sector_offset_, slip_force_, stiffness_, chi_, beta_, elements_, &first_id_);
  give_number(a, (double)first_id_);
  finish(a, status_);
}

static void call_model_add_table(Call *a) {
  hbvib_model *model_ = handle(a, "model");
  int64_t dof_a_ = whole(a, "dof_a");
  int64_t dof_b_ = whole(a, "dof_b");
  int64_t sector_offset_ = whole(a, "sector_offset");
  int64_t n_ = whole(a, "n");
  const double *displacement_ = reals(a, "displacement");
  const double *force_ = reals(a, "force");
  int64_t id_ = 0;
  hbvib_status status_ = hbvib_model_add_table(model_, dof_a_, dof_b_, sector_offset_, n_, displacement_, force_, &id_);
  give_number(a, (double)id_);
  finish(a, status_);
}

static void call_model_add_spring_damper(Call *a) {
  hbvib_model *model_ = handle(a, "model");
  int64_t dof_a_ = whole(a, "dof_a");
  int64_t dof_b_ = whole(a, "dof_b");
  int64_t sector_offset_ = whole(a, "sector_offset");
  int64_t n_spring_ = whole(a, "n_spring");
  const double *spring_ = reals(a, "spring");
  int64_t n_damper_ = whole(a, "n_damper");
  const double *damper_ = reals(a, "damper");
  int64_t id_ = 0;
  hbvib_status status_ = hbvib_model_add_spring_damper(model_, dof_a_, dof_b_, sector_offset_, n_spring_, spring_, n_damper_, damper_, &id_);
  give_number(a, (double)id_);
  finish(a, status_);
}

static void call_model_add_polynomial(Call *a) {
  hbvib_model *model_ = handle(a, "model");
  const int64_t *dofs_ = wholes(a, "dofs");
  int64_t n_dofs_ = whole(a, "n_dofs");
  int64_t n_terms_ = whole(a, "n_terms");
  const int64_t *direction_ = wholes(a, "direction");
  const double *coefficient_ = reals(a, "coefficient");
  const int32_t *x_powers_ = wholes32(a, "x_powers");
  const int32_t *v_powers_ = wholes32(a, "v_powers");
  int64_t id_ = 0;
  hbvib_status status_ = hbvib_model_add_polynomial(model_, dofs_, n_dofs_, n_terms_, direction_, coefficient_, x_powers_, v_powers_, &id_);
  give_number(a, (double)id_);
  finish(a, status_);
}

static void call_model_add_stiffness_tensors(Call *a) {
  hbvib_model *model_ = handle(a, "model");
  const int64_t *dofs_ = wholes(a, "dofs");
  int64_t n_ = whole(a, "n");
  const double *quadratic_ = reals(a, "quadratic");
  const double *cubic_ = reals(a, "cubic");
  int64_t id_ = 0;
  hbvib_status status_ = hbvib_model_add_stiffness_tensors(model_, dofs_, n_, quadratic_, cubic_, &id_);
  give_number(a, (double)id_);
  finish(a, status_);
}

static void call_model_add_patch(Call *a) {
  hbvib_model *model_ = handle(a, "model");
  const hbvib_contact *law_ = structs(a, "law", &CONTACT_STRUCT);
  int64_t n_ = whole(a, "n");
  const int64_t *dof_a_ = wholes(a, "dof_a");
  const int64_t *dof_b_ = wholes(a, "dof_b");
  const double *normal_ = reals(a, "normal");
  const double *tangent_ = reals(a, "tangent");
  const double *area_ = reals(a, "area");
  const double *pressure_ = reals(a, "pressure");
  const double *gap_ = reals(a, "gap");
  int64_t first_id_ = 0;
  hbvib_status status_ = hbvib_model_add_patch(model_, law_, n_, dof_a_, dof_b_, normal_, tangent_, area_, pressure_, gap_, &first_id_);
  give_number(a, (double)first_id_);
  finish(a, status_);
}

static void call_model_add_damper(Call *a) {
  hbvib_model *model_ = handle(a, "model");
  const hbvib_damper *damper_ = structs(a, "damper", &DAMPER_STRUCT);
  int64_t first_dof_ = 0;
  int64_t first_contact_ = 0;
  hbvib_status status_ = hbvib_model_add_damper(model_, damper_, &first_dof_, &first_contact_);
  give_number(a, (double)first_dof_);
  give_number(a, (double)first_contact_);
  finish(a, status_);
}

static void call_model_contact(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  int64_t id_ = whole(a, "id");
  hbvib_contact out_;
  hbvib_contact_init(&out_, sizeof out_);
  int64_t per_speed2_n = room(a, "per_speed2");
  double *per_speed2_ = array(per_speed2_n, 1 * sizeof(double));
  hbvib_status status_ = hbvib_model_contact(model_, id_, &out_, per_speed2_);
  give_struct(a, &out_, &CONTACT_STRUCT);
  give_reals(a, per_speed2_, per_speed2_n);
  finish(a, status_);
}

static void call_check_jacobian(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  int64_t contact_ = whole(a, "contact");
  double omega_ = real(a, "omega");
  const double *amplitude_ = reals(a, "amplitude");
  int64_t amplitude_len_ = whole(a, "amplitude_len");
  hbvib_jacobian_gap out_;
  hbvib_jacobian_gap_init(&out_, sizeof out_);
  hbvib_status status_ = hbvib_check_jacobian(model_, contact_, omega_, amplitude_, amplitude_len_, &out_);
  give_struct(a, &out_, &JACOBIAN_GAP_STRUCT);
  finish(a, status_);
}

static void call_forced_response(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  const hbvib_solver_options *solver_ = structs(a, "solver", &SOLVER_OPTIONS_STRUCT);
  const hbvib_forced_options *forced_ = structs(a, "forced", &FORCED_OPTIONS_STRUCT);
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  hbvib_branch *out_ = NULL;
  hbvib_status status_ = hbvib_forced_response(model_, solver_, forced_, hooks_, &out_);
  give_branch(a, out_);
  finish(a, status_);
}

static void call_branch_children(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  double result_ = (double)hbvib_branch_children(branch_);
  give_count(a, result_);
}

static void call_branch_child(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t number_ = whole(a, "number");
  hbvib_branch *out_ = NULL;
  hbvib_status status_ = hbvib_branch_child(branch_, number_, &out_);
  give_branch(a, out_);
  finish(a, status_);
}

static void call_branch_descent(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  hbvib_descent out_;
  hbvib_descent_init(&out_, sizeof out_);
  hbvib_status status_ = hbvib_branch_descent(branch_, &out_);
  give_struct(a, &out_, &DESCENT_STRUCT);
  finish(a, status_);
}

static void call_branch_searched(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  hbvib_searched out_;
  hbvib_searched_init(&out_, sizeof out_);
  hbvib_status status_ = hbvib_branch_searched(branch_, &out_);
  give_struct(a, &out_, &SEARCHED_STRUCT);
  finish(a, status_);
}

static void call_model_longer_period(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  int64_t periods_ = whole(a, "periods");
  hbvib_model *out_ = NULL;
  hbvib_status status_ = hbvib_model_longer_period(model_, periods_, &out_);
  give_model(a, out_);
  finish(a, status_);
}

static void call_branch_free(Call *a) {
  hbvib_branch *branch_ = handle(a, "branch");
  hbvib_status status_ = hbvib_branch_free(branch_);
  finish(a, status_);
}

static void call_branch_points(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  double result_ = (double)hbvib_branch_points(branch_);
  give_count(a, result_);
}

static void call_branch_stored(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  double result_ = (double)hbvib_branch_stored(branch_);
  give_count(a, result_);
}

static void call_branch_status(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  hbvib_status status_ = hbvib_branch_status(branch_);
  finish(a, status_);
}

static void call_branch_field(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  int32_t field_ = (int32_t)whole32(a, "field");
  hbvib_view out_;
  hbvib_view_init(&out_, sizeof out_);
  hbvib_status status_ = hbvib_branch_field(branch_, field_, &out_);
  give_view(a, &out_);
  finish(a, status_);
}

static void call_branch_stored_field(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  int32_t field_ = (int32_t)whole32(a, "field");
  hbvib_view out_;
  hbvib_view_init(&out_, sizeof out_);
  hbvib_status status_ = hbvib_branch_stored_field(branch_, field_, &out_);
  give_view(a, &out_);
  finish(a, status_);
}

static void call_branch_harmonics(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t point_ = whole(a, "point");
  int64_t first_dof_ = whole(a, "first_dof");
  int64_t n_dof_ = whole(a, "n_dof");
  int64_t x_n = room(a, "x");
  double *x_ = array(x_n, 2 * sizeof(double));
  int64_t x_len_ = whole(a, "x_len");
  hbvib_status status_ = hbvib_branch_harmonics(branch_, point_, first_dof_, n_dof_, x_, x_len_);
  give_complexes(a, x_, x_n);
  finish(a, status_);
}

static void call_branch_harmonics_with_hooks(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t point_ = whole(a, "point");
  int64_t first_dof_ = whole(a, "first_dof");
  int64_t n_dof_ = whole(a, "n_dof");
  int64_t x_n = room(a, "x");
  double *x_ = array(x_n, 2 * sizeof(double));
  int64_t x_len_ = whole(a, "x_len");
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  hbvib_status status_ = hbvib_branch_harmonics_with_hooks(branch_, point_, first_dof_, n_dof_, x_, x_len_, hooks_);
  give_complexes(a, x_, x_n);
  finish(a, status_);
}

static void call_branch_time_history(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t point_ = whole(a, "point");
  int64_t dof_ = whole(a, "dof");
  int64_t n_ = whole(a, "n");
  int64_t x_n = room(a, "x");
  double *x_ = array(x_n, 1 * sizeof(double));
  hbvib_status status_ = hbvib_branch_time_history(branch_, point_, dof_, n_, x_);
  give_reals(a, x_, x_n);
  finish(a, status_);
}

static void call_branch_time_history_with_hooks(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t point_ = whole(a, "point");
  int64_t dof_ = whole(a, "dof");
  int64_t n_ = whole(a, "n");
  int64_t x_n = room(a, "x");
  double *x_ = array(x_n, 1 * sizeof(double));
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  hbvib_status status_ = hbvib_branch_time_history_with_hooks(branch_, point_, dof_, n_, x_, hooks_);
  give_reals(a, x_, x_n);
  finish(a, status_);
}

static void call_branch_slip_fraction(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t point_ = whole(a, "point");
  int64_t shares_n = room(a, "shares");
  double *shares_ = array(shares_n, 1 * sizeof(double));
  int64_t shares_len_ = whole(a, "shares_len");
  hbvib_status status_ = hbvib_branch_slip_fraction(branch_, point_, shares_, shares_len_);
  give_reals(a, shares_, shares_n);
  finish(a, status_);
}

static void call_branch_peaks(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t capacity_ = whole(a, "capacity");
  int64_t omega_n = room(a, "omega");
  double *omega_ = array(omega_n, 1 * sizeof(double));
  int64_t amplitude_n = room(a, "amplitude");
  double *amplitude_ = array(amplitude_n, 1 * sizeof(double));
  int64_t point_n = room(a, "point");
  int64_t *point_ = array(point_n, 1 * sizeof(int64_t));
  int64_t count_ = 0;
  hbvib_status status_ = hbvib_branch_peaks(branch_, capacity_, omega_, amplitude_, point_, &count_);
  give_reals(a, omega_, omega_n);
  give_reals(a, amplitude_, amplitude_n);
  give_wholes(a, point_, point_n);
  give_number(a, (double)count_);
  finish(a, status_);
}

static void call_branch_folds(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t capacity_ = whole(a, "capacity");
  int64_t omega_n = room(a, "omega");
  double *omega_ = array(omega_n, 1 * sizeof(double));
  int64_t amplitude_n = room(a, "amplitude");
  double *amplitude_ = array(amplitude_n, 1 * sizeof(double));
  int64_t point_n = room(a, "point");
  int64_t *point_ = array(point_n, 1 * sizeof(int64_t));
  int64_t count_ = 0;
  hbvib_status status_ = hbvib_branch_folds(branch_, capacity_, omega_, amplitude_, point_, &count_);
  give_reals(a, omega_, omega_n);
  give_reals(a, amplitude_, amplitude_n);
  give_wholes(a, point_, point_n);
  give_number(a, (double)count_);
  finish(a, status_);
}

static void call_branch_at(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t wanted_ = whole(a, "wanted");
  int64_t capacity_ = whole(a, "capacity");
  int64_t amplitude_n = room(a, "amplitude");
  double *amplitude_ = array(amplitude_n, 1 * sizeof(double));
  int64_t point_n = room(a, "point");
  int64_t *point_ = array(point_n, 1 * sizeof(int64_t));
  int64_t count_ = 0;
  hbvib_status status_ = hbvib_branch_at(branch_, wanted_, capacity_, amplitude_, point_, &count_);
  give_reals(a, amplitude_, amplitude_n);
  give_wholes(a, point_, point_n);
  give_number(a, (double)count_);
  finish(a, status_);
}

static void call_branch_responses(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  double result_ = (double)hbvib_branch_responses(branch_);
  give_count(a, result_);
}

static void call_branch_response(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t response_ = whole(a, "response");
  int32_t reading_ = (int32_t)whole32(a, "reading");
  hbvib_view out_;
  hbvib_view_init(&out_, sizeof out_);
  hbvib_status status_ = hbvib_branch_response(branch_, response_, reading_, &out_);
  give_view(a, &out_);
  finish(a, status_);
}

static void call_branch_response_peaks(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t response_ = whole(a, "response");
  int64_t capacity_ = whole(a, "capacity");
  int64_t omega_n = room(a, "omega");
  double *omega_ = array(omega_n, 1 * sizeof(double));
  int64_t value_n = room(a, "value");
  double *value_ = array(value_n, 1 * sizeof(double));
  int64_t point_n = room(a, "point");
  int64_t *point_ = array(point_n, 1 * sizeof(int64_t));
  int64_t peaks_ = 0;
  hbvib_status status_ = hbvib_branch_response_peaks(branch_, response_, capacity_, omega_, value_, point_, &peaks_);
  give_reals(a, omega_, omega_n);
  give_reals(a, value_, value_n);
  give_wholes(a, point_, point_n);
  give_number(a, (double)peaks_);
  finish(a, status_);
}

static void call_branch_response_kinks(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t response_ = whole(a, "response");
  int64_t capacity_ = whole(a, "capacity");
  int64_t omega_n = room(a, "omega");
  double *omega_ = array(omega_n, 1 * sizeof(double));
  int64_t value_n = room(a, "value");
  double *value_ = array(value_n, 1 * sizeof(double));
  int64_t before_n = room(a, "before");
  int64_t *before_ = array(before_n, 1 * sizeof(int64_t));
  int64_t after_n = room(a, "after");
  int64_t *after_ = array(after_n, 1 * sizeof(int64_t));
  int64_t kinks_ = 0;
  hbvib_status status_ = hbvib_branch_response_kinks(branch_, response_, capacity_, omega_, value_, before_, after_, &kinks_);
  give_reals(a, omega_, omega_n);
  give_reals(a, value_, value_n);
  give_wholes(a, before_, before_n);
  give_wholes(a, after_, after_n);
  give_number(a, (double)kinks_);
  finish(a, status_);
}

static void call_branch_leading_response(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t point_ = whole(a, "point");
  double result_ = (double)hbvib_branch_leading_response(branch_, point_);
  give_count(a, result_);
}

static void call_branch_read_responses(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  const hbvib_response *responses_ = structs(a, "responses", &RESPONSE_STRUCT);
  int64_t responses_len_ = whole(a, "responses_len");
  int64_t values_n = room(a, "values");
  double *values_ = array(values_n, 1 * sizeof(double));
  int64_t values_len_ = whole(a, "values_len");
  int64_t complex_n = room(a, "complex");
  double *complex_ = array(complex_n, 2 * sizeof(double));
  int64_t complex_len_ = whole(a, "complex_len");
  int64_t instants_n = room(a, "instants");
  double *instants_ = array(instants_n, 1 * sizeof(double));
  int64_t instants_len_ = whole(a, "instants_len");
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  hbvib_status status_ = hbvib_branch_read_responses(branch_, responses_, responses_len_, values_, values_len_, complex_, complex_len_, instants_, instants_len_, hooks_);
  give_reals(a, values_, values_n);
  give_complexes(a, complex_, complex_n);
  give_reals(a, instants_, instants_n);
  finish(a, status_);
}

static void call_response_of(Call *a) {
  const hbvib_response *r_ = structs(a, "r", &RESPONSE_STRUCT);
  int64_t ndof_ = whole(a, "ndof");
  double omega_ = real(a, "omega");
  const double *x_ = complexes(a, "x");
  int64_t x_len_ = whole(a, "x_len");
  int64_t value_n = room(a, "value");
  double *value_ = array(value_n, 1 * sizeof(double));
  int64_t amplitude_n = room(a, "amplitude");
  double *amplitude_ = array(amplitude_n, 2 * sizeof(double));
  int64_t instant_n = room(a, "instant");
  double *instant_ = array(instant_n, 1 * sizeof(double));
  hbvib_status status_ = hbvib_response_of(r_, ndof_, omega_, x_, x_len_, value_, amplitude_, instant_);
  give_reals(a, value_, value_n);
  give_complexes(a, amplitude_, amplitude_n);
  give_reals(a, instant_, instant_n);
  finish(a, status_);
}

static void call_branch_reduction(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  hbvib_reduction out_;
  hbvib_reduction_init(&out_, sizeof out_);
  hbvib_status status_ = hbvib_branch_reduction(branch_, &out_);
  give_struct(a, &out_, &REDUCTION_STRUCT);
  finish(a, status_);
}

static void call_branch_energy(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t point_ = whole(a, "point");
  hbvib_energy out_;
  hbvib_energy_init(&out_, sizeof out_);
  hbvib_status status_ = hbvib_branch_energy(branch_, point_, &out_);
  give_struct(a, &out_, &ENERGY_STRUCT);
  finish(a, status_);
}

static void call_branch_energy_with_hooks(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t point_ = whole(a, "point");
  hbvib_energy out_;
  hbvib_energy_init(&out_, sizeof out_);
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  hbvib_status status_ = hbvib_branch_energy_with_hooks(branch_, point_, &out_, hooks_);
  give_struct(a, &out_, &ENERGY_STRUCT);
  finish(a, status_);
}

static void call_branch_contact_loop(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t point_ = whole(a, "point");
  int64_t contact_ = whole(a, "contact");
  int64_t direction_ = whole(a, "direction");
  int64_t n_ = whole(a, "n");
  int64_t motion_n = room(a, "motion");
  double *motion_ = array(motion_n, 1 * sizeof(double));
  int64_t force_n = room(a, "force");
  double *force_ = array(force_n, 1 * sizeof(double));
  int64_t state_n = room(a, "state");
  int32_t *state_ = array(state_n, 1 * sizeof(int32_t));
  hbvib_status status_ = hbvib_branch_contact_loop(branch_, point_, contact_, direction_, n_, motion_, force_, state_);
  give_reals(a, motion_, motion_n);
  give_reals(a, force_, force_n);
  give_wholes32(a, state_, state_n);
  finish(a, status_);
}

static void call_branch_contact_loop_with_hooks(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t point_ = whole(a, "point");
  int64_t contact_ = whole(a, "contact");
  int64_t direction_ = whole(a, "direction");
  int64_t n_ = whole(a, "n");
  int64_t motion_n = room(a, "motion");
  double *motion_ = array(motion_n, 1 * sizeof(double));
  int64_t force_n = room(a, "force");
  double *force_ = array(force_n, 1 * sizeof(double));
  int64_t state_n = room(a, "state");
  int32_t *state_ = array(state_n, 1 * sizeof(int32_t));
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  hbvib_status status_ = hbvib_branch_contact_loop_with_hooks(branch_, point_, contact_, direction_, n_, motion_, force_, state_, hooks_);
  give_reals(a, motion_, motion_n);
  give_reals(a, force_, force_n);
  give_wholes32(a, state_, state_n);
  finish(a, status_);
}

static void call_branch_contact_summary(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t point_ = whole(a, "point");
  int64_t contact_ = whole(a, "contact");
  hbvib_contact_summary out_;
  hbvib_contact_summary_init(&out_, sizeof out_);
  hbvib_status status_ = hbvib_branch_contact_summary(branch_, point_, contact_, &out_);
  give_struct(a, &out_, &CONTACT_SUMMARY_STRUCT);
  finish(a, status_);
}

static void call_branch_contact_summary_with_hooks(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t point_ = whole(a, "point");
  int64_t contact_ = whole(a, "contact");
  hbvib_contact_summary out_;
  hbvib_contact_summary_init(&out_, sizeof out_);
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  hbvib_status status_ = hbvib_branch_contact_summary_with_hooks(branch_, point_, contact_, &out_, hooks_);
  give_struct(a, &out_, &CONTACT_SUMMARY_STRUCT);
  finish(a, status_);
}

static void call_linear_modes(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  int64_t diameter_ = whole(a, "diameter");
  int32_t contacts_ = (int32_t)whole32(a, "contacts");
  int64_t count_ = whole(a, "count");
  int64_t omega_n = room(a, "omega");
  double *omega_ = array(omega_n, 1 * sizeof(double));
  int64_t shapes_n = room(a, "shapes");
  double *shapes_ = array(shapes_n, 2 * sizeof(double));
  hbvib_status status_ = hbvib_linear_modes(model_, diameter_, contacts_, count_, omega_, shapes_);
  give_reals(a, omega_, omega_n);
  give_complexes(a, shapes_, shapes_n);
  finish(a, status_);
}

static void call_linear_modes_with_hooks(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  int64_t diameter_ = whole(a, "diameter");
  int32_t contacts_ = (int32_t)whole32(a, "contacts");
  int64_t count_ = whole(a, "count");
  int64_t omega_n = room(a, "omega");
  double *omega_ = array(omega_n, 1 * sizeof(double));
  int64_t shapes_n = room(a, "shapes");
  double *shapes_ = array(shapes_n, 2 * sizeof(double));
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  hbvib_status status_ = hbvib_linear_modes_with_hooks(model_, diameter_, contacts_, count_, omega_, shapes_, hooks_);
  give_reals(a, omega_, omega_n);
  give_complexes(a, shapes_, shapes_n);
  finish(a, status_);
}

static void call_damped_modes(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  int64_t diameter_ = whole(a, "diameter");
  int32_t contacts_ = (int32_t)whole32(a, "contacts");
  int64_t count_ = whole(a, "count");
  int64_t eigenvalue_n = room(a, "eigenvalue");
  double *eigenvalue_ = array(eigenvalue_n, 2 * sizeof(double));
  int64_t shapes_n = room(a, "shapes");
  double *shapes_ = array(shapes_n, 2 * sizeof(double));
  int64_t direction_n = room(a, "direction");
  int64_t *direction_ = array(direction_n, 1 * sizeof(int64_t));
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  hbvib_status status_ = hbvib_damped_modes(model_, diameter_, contacts_, count_, eigenvalue_, shapes_, direction_, hooks_);
  give_complexes(a, eigenvalue_, eigenvalue_n);
  give_complexes(a, shapes_, shapes_n);
  give_wholes(a, direction_, direction_n);
  finish(a, status_);
}

static void call_campbell(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  int64_t n_ = whole(a, "n");
  const double *speeds_ = reals(a, "speeds");
  int64_t diameter_ = whole(a, "diameter");
  int32_t contacts_ = (int32_t)whole32(a, "contacts");
  int64_t count_ = whole(a, "count");
  int64_t omega_n = room(a, "omega");
  double *omega_ = array(omega_n, 1 * sizeof(double));
  int64_t damping_ratio_n = room(a, "damping_ratio");
  double *damping_ratio_ = array(damping_ratio_n, 1 * sizeof(double));
  int64_t direction_n = room(a, "direction");
  int64_t *direction_ = array(direction_n, 1 * sizeof(int64_t));
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  hbvib_status status_ = hbvib_campbell(model_, n_, speeds_, diameter_, contacts_, count_, omega_, damping_ratio_, direction_, hooks_);
  give_reals(a, omega_, omega_n);
  give_reals(a, damping_ratio_, damping_ratio_n);
  give_wholes(a, direction_, direction_n);
  finish(a, status_);
}

static void call_campbell_crossings(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  int64_t n_ = whole(a, "n");
  const double *speeds_ = reals(a, "speeds");
  int64_t diameter_ = whole(a, "diameter");
  int32_t contacts_ = (int32_t)whole32(a, "contacts");
  int64_t count_ = whole(a, "count");
  int64_t engine_order_ = whole(a, "engine_order");
  int64_t capacity_ = whole(a, "capacity");
  int64_t speed_n = room(a, "speed");
  double *speed_ = array(speed_n, 1 * sizeof(double));
  int64_t omega_n = room(a, "omega");
  double *omega_ = array(omega_n, 1 * sizeof(double));
  int64_t direction_n = room(a, "direction");
  int64_t *direction_ = array(direction_n, 1 * sizeof(int64_t));
  int64_t found_ = 0;
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  hbvib_status status_ = hbvib_campbell_crossings(model_, n_, speeds_, diameter_, contacts_, count_, engine_order_, capacity_, speed_, omega_, direction_, &found_, hooks_);
  give_reals(a, speed_, speed_n);
  give_reals(a, omega_, omega_n);
  give_wholes(a, direction_, direction_n);
  give_number(a, (double)found_);
  finish(a, status_);
}

static void call_interference(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  int32_t contacts_ = (int32_t)whole32(a, "contacts");
  int64_t count_ = whole(a, "count");
  int64_t capacity_ = whole(a, "capacity");
  int64_t diameter_n = room(a, "diameter");
  int64_t *diameter_ = array(diameter_n, 1 * sizeof(int64_t));
  int64_t omega_n = room(a, "omega");
  double *omega_ = array(omega_n, 1 * sizeof(double));
  int64_t damping_ratio_n = room(a, "damping_ratio");
  double *damping_ratio_ = array(damping_ratio_n, 1 * sizeof(double));
  int64_t direction_n = room(a, "direction");
  int64_t *direction_ = array(direction_n, 1 * sizeof(int64_t));
  int64_t equal_senses_ = 0;
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  hbvib_status status_ = hbvib_interference(model_, contacts_, count_, capacity_, diameter_, omega_, damping_ratio_, direction_, &equal_senses_, hooks_);
  give_wholes(a, diameter_, diameter_n);
  give_reals(a, omega_, omega_n);
  give_reals(a, damping_ratio_, damping_ratio_n);
  give_wholes(a, direction_, direction_n);
  give_number(a, (double)equal_senses_);
  finish(a, status_);
}

static void call_nonlinear_mode(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  const hbvib_solver_options *solver_ = structs(a, "solver", &SOLVER_OPTIONS_STRUCT);
  const hbvib_mode_options *mode_ = structs(a, "mode", &MODE_OPTIONS_STRUCT);
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  hbvib_branch *out_ = NULL;
  hbvib_status status_ = hbvib_nonlinear_mode(model_, solver_, mode_, hooks_, &out_);
  give_branch(a, out_);
  finish(a, status_);
}

static void call_branch_mode_point(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t point_ = whole(a, "point");
  hbvib_mode_point out_;
  hbvib_mode_point_init(&out_, sizeof out_);
  hbvib_status status_ = hbvib_branch_mode_point(branch_, point_, &out_);
  give_struct(a, &out_, &MODE_POINT_STRUCT);
  finish(a, status_);
}

static void call_branch_mode_info(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  hbvib_mode_info out_;
  hbvib_mode_info_init(&out_, sizeof out_);
  hbvib_status status_ = hbvib_branch_mode_info(branch_, &out_);
  give_struct(a, &out_, &MODE_INFO_STRUCT);
  finish(a, status_);
}

static void call_branch_synthesis(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  const hbvib_model *model_ = handle(a, "model");
  const hbvib_synthesis_options *options_ = structs(a, "options", &SYNTHESIS_OPTIONS_STRUCT);
  int64_t capacity_ = whole(a, "capacity");
  int64_t omega_n = room(a, "omega");
  double *omega_ = array(omega_n, 1 * sizeof(double));
  int64_t response_n = room(a, "response");
  double *response_ = array(response_n, 2 * sizeof(double));
  int64_t modal_amplitude_n = room(a, "modal_amplitude");
  double *modal_amplitude_ = array(modal_amplitude_n, 1 * sizeof(double));
  int64_t count_ = 0;
  hbvib_status status_ = hbvib_branch_synthesis(branch_, model_, options_, capacity_, omega_, response_, modal_amplitude_, &count_);
  give_reals(a, omega_, omega_n);
  give_complexes(a, response_, response_n);
  give_reals(a, modal_amplitude_, modal_amplitude_n);
  give_number(a, (double)count_);
  finish(a, status_);
}

static void call_branch_synthesis_with_hooks(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  const hbvib_model *model_ = handle(a, "model");
  const hbvib_synthesis_options *options_ = structs(a, "options", &SYNTHESIS_OPTIONS_STRUCT);
  int64_t capacity_ = whole(a, "capacity");
  int64_t omega_n = room(a, "omega");
  double *omega_ = array(omega_n, 1 * sizeof(double));
  int64_t response_n = room(a, "response");
  double *response_ = array(response_n, 2 * sizeof(double));
  int64_t modal_amplitude_n = room(a, "modal_amplitude");
  double *modal_amplitude_ = array(modal_amplitude_n, 1 * sizeof(double));
  int64_t count_ = 0;
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  hbvib_status status_ = hbvib_branch_synthesis_with_hooks(branch_, model_, options_, capacity_, omega_, response_, modal_amplitude_, &count_, hooks_);
  give_reals(a, omega_, omega_n);
  give_complexes(a, response_, response_n);
  give_reals(a, modal_amplitude_, modal_amplitude_n);
  give_number(a, (double)count_);
  finish(a, status_);
}

static void call_branch_synthesis_peaks(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  const hbvib_model *model_ = handle(a, "model");
  const hbvib_synthesis_options *options_ = structs(a, "options", &SYNTHESIS_OPTIONS_STRUCT);
  int64_t capacity_ = whole(a, "capacity");
  int64_t omega_n = room(a, "omega");
  double *omega_ = array(omega_n, 1 * sizeof(double));
  int64_t amplitude_n = room(a, "amplitude");
  double *amplitude_ = array(amplitude_n, 1 * sizeof(double));
  int64_t log10_amplitude_n = room(a, "log10_amplitude");
  double *log10_amplitude_ = array(log10_amplitude_n, 1 * sizeof(double));
  int64_t damping_ratio_n = room(a, "damping_ratio");
  double *damping_ratio_ = array(damping_ratio_n, 1 * sizeof(double));
  int64_t other_mode_n = room(a, "other_mode");
  double *other_mode_ = array(other_mode_n, 1 * sizeof(double));
  int64_t error_n = room(a, "error");
  double *error_ = array(error_n, 1 * sizeof(double));
  int64_t flags_n = room(a, "flags");
  int32_t *flags_ = array(flags_n, 1 * sizeof(int32_t));
  int64_t count_ = 0;
  hbvib_status status_ = hbvib_branch_synthesis_peaks(branch_, model_, options_, capacity_, omega_, amplitude_, log10_amplitude_, damping_ratio_, other_mode_, error_, flags_, &count_);
  give_reals(a, omega_, omega_n);
  give_reals(a, amplitude_, amplitude_n);
  give_reals(a, log10_amplitude_, log10_amplitude_n);
  give_reals(a, damping_ratio_, damping_ratio_n);
  give_reals(a, other_mode_, other_mode_n);
  give_reals(a, error_, error_n);
  give_wholes32(a, flags_, flags_n);
  give_number(a, (double)count_);
  finish(a, status_);
}

static void call_branch_synthesis_peaks_with_hooks(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  const hbvib_model *model_ = handle(a, "model");
  const hbvib_synthesis_options *options_ = structs(a, "options", &SYNTHESIS_OPTIONS_STRUCT);
  int64_t capacity_ = whole(a, "capacity");
  int64_t omega_n = room(a, "omega");
  double *omega_ = array(omega_n, 1 * sizeof(double));
  int64_t amplitude_n = room(a, "amplitude");
  double *amplitude_ = array(amplitude_n, 1 * sizeof(double));
  int64_t log10_amplitude_n = room(a, "log10_amplitude");
  double *log10_amplitude_ = array(log10_amplitude_n, 1 * sizeof(double));
  int64_t damping_ratio_n = room(a, "damping_ratio");
  double *damping_ratio_ = array(damping_ratio_n, 1 * sizeof(double));
  int64_t other_mode_n = room(a, "other_mode");
  double *other_mode_ = array(other_mode_n, 1 * sizeof(double));
  int64_t error_n = room(a, "error");
  double *error_ = array(error_n, 1 * sizeof(double));
  int64_t flags_n = room(a, "flags");
  int32_t *flags_ = array(flags_n, 1 * sizeof(int32_t));
  int64_t count_ = 0;
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  hbvib_status status_ = hbvib_branch_synthesis_peaks_with_hooks(branch_, model_, options_, capacity_, omega_, amplitude_, log10_amplitude_, damping_ratio_, other_mode_, error_, flags_, &count_, hooks_);
  give_reals(a, omega_, omega_n);
  give_reals(a, amplitude_, amplitude_n);
  give_reals(a, log10_amplitude_, log10_amplitude_n);
  give_reals(a, damping_ratio_, damping_ratio_n);
  give_reals(a, other_mode_, other_mode_n);
  give_reals(a, error_, error_n);
  give_wholes32(a, flags_, flags_n);
  give_number(a, (double)count_);
  finish(a, status_);
}

static void call_time_response(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  const hbvib_time_options *options_ = structs(a, "options", &TIME_OPTIONS_STRUCT);
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  int64_t harmonics_n = room(a, "harmonics");
  double *harmonics_ = array(harmonics_n, 2 * sizeof(double));
  int64_t harmonics_len_ = whole(a, "harmonics_len");
  int64_t samples_n = room(a, "samples");
  double *samples_ = array(samples_n, 1 * sizeof(double));
  int64_t samples_len_ = whole(a, "samples_len");
  hbvib_time_info info_;
  hbvib_time_info_init(&info_, sizeof info_);
  hbvib_status status_ = hbvib_time_response(model_, options_, hooks_, harmonics_, harmonics_len_, samples_, samples_len_, &info_);
  give_complexes(a, harmonics_, harmonics_n);
  give_reals(a, samples_, samples_n);
  give_struct(a, &info_, &TIME_INFO_STRUCT);
  finish(a, status_);
}

static void call_time_sweep(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  const hbvib_sweep_options *options_ = structs(a, "options", &SWEEP_OPTIONS_STRUCT);
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  int64_t capacity_ = whole(a, "capacity");
  int64_t time_n = room(a, "time");
  double *time_ = array(time_n, 1 * sizeof(double));
  int64_t omega_n = room(a, "omega");
  double *omega_ = array(omega_n, 1 * sizeof(double));
  int64_t amplitude_n = room(a, "amplitude");
  double *amplitude_ = array(amplitude_n, 1 * sizeof(double));
  int64_t count_ = 0;
  hbvib_sweep_info info_;
  hbvib_sweep_info_init(&info_, sizeof info_);
  hbvib_status status_ = hbvib_time_sweep(model_, options_, hooks_, capacity_, time_, omega_, amplitude_, &count_, &info_);
  give_reals(a, time_, time_n);
  give_reals(a, omega_, omega_n);
  give_reals(a, amplitude_, amplitude_n);
  give_number(a, (double)count_);
  give_struct(a, &info_, &SWEEP_INFO_STRUCT);
  finish(a, status_);
}

static void call_branch_run_up(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  const hbvib_model *model_ = handle(a, "model");
  const hbvib_run_up_options *options_ = structs(a, "options", &RUN_UP_OPTIONS_STRUCT);
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  int64_t capacity_ = whole(a, "capacity");
  int64_t time_n = room(a, "time");
  double *time_ = array(time_n, 1 * sizeof(double));
  int64_t omega_n = room(a, "omega");
  double *omega_ = array(omega_n, 1 * sizeof(double));
  int64_t amplitude_n = room(a, "amplitude");
  double *amplitude_ = array(amplitude_n, 1 * sizeof(double));
  int64_t modal_amplitude_n = room(a, "modal_amplitude");
  double *modal_amplitude_ = array(modal_amplitude_n, 1 * sizeof(double));
  int64_t count_ = 0;
  hbvib_run_up_info info_;
  hbvib_run_up_info_init(&info_, sizeof info_);
  hbvib_status status_ = hbvib_branch_run_up(branch_, model_, options_, hooks_, capacity_, time_, omega_, amplitude_, modal_amplitude_, &count_, &info_);
  give_reals(a, time_, time_n);
  give_reals(a, omega_, omega_n);
  give_reals(a, amplitude_, amplitude_n);
  give_reals(a, modal_amplitude_, modal_amplitude_n);
  give_number(a, (double)count_);
  give_struct(a, &info_, &RUN_UP_INFO_STRUCT);
  finish(a, status_);
}

static void call_branch_mission(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  const hbvib_model *model_ = handle(a, "model");
  const hbvib_mission_options *options_ = structs(a, "options", &MISSION_OPTIONS_STRUCT);
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  int64_t amplitude_n = room(a, "amplitude");
  double *amplitude_ = array(amplitude_n, 1 * sizeof(double));
  int64_t cycles_n = room(a, "cycles");
  double *cycles_ = array(cycles_n, 1 * sizeof(double));
  int64_t damage_n = room(a, "damage");
  double *damage_ = array(damage_n, 1 * sizeof(double));
  int64_t capacity_ = whole(a, "capacity");
  int64_t crossing_n = room(a, "crossing");
  double *crossing_ = array(crossing_n, 1 * sizeof(double));
  int64_t count_ = 0;
  int64_t error_n = room(a, "error");
  double *error_ = array(error_n, 1 * sizeof(double));
  hbvib_status status_ = hbvib_branch_mission(branch_, model_, options_, hooks_, amplitude_, cycles_, damage_, capacity_, crossing_, &count_, error_);
  give_reals(a, amplitude_, amplitude_n);
  give_reals(a, cycles_, cycles_n);
  give_reals(a, damage_, damage_n);
  give_reals(a, crossing_, crossing_n);
  give_number(a, (double)count_);
  give_reals(a, error_, error_n);
  finish(a, status_);
}

static void call_campbell_response(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  const hbvib_model *model_ = handle(a, "model");
  const hbvib_campbell_options *options_ = structs(a, "options", &CAMPBELL_OPTIONS_STRUCT);
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  int64_t n_ = whole(a, "n");
  const double *force_factors_ = reals(a, "force_factors");
  int64_t speed_n = room(a, "speed");
  double *speed_ = array(speed_n, 1 * sizeof(double));
  int64_t omega_n = room(a, "omega");
  double *omega_ = array(omega_n, 1 * sizeof(double));
  int64_t amplitude_n = room(a, "amplitude");
  double *amplitude_ = array(amplitude_n, 1 * sizeof(double));
  int64_t damping_ratio_n = room(a, "damping_ratio");
  double *damping_ratio_ = array(damping_ratio_n, 1 * sizeof(double));
  int64_t passed_n = room(a, "passed");
  double *passed_ = array(passed_n, 1 * sizeof(double));
  int64_t error_n = room(a, "error");
  double *error_ = array(error_n, 1 * sizeof(double));
  hbvib_status status_ = hbvib_campbell_response(branch_, model_, options_, hooks_, n_, force_factors_, speed_, omega_, amplitude_, damping_ratio_, passed_, error_);
  give_reals(a, speed_, speed_n);
  give_reals(a, omega_, omega_n);
  give_reals(a, amplitude_, amplitude_n);
  give_reals(a, damping_ratio_, damping_ratio_n);
  give_reals(a, passed_, passed_n);
  give_reals(a, error_, error_n);
  finish(a, status_);
}

static void call_verify(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t point_ = whole(a, "point");
  const hbvib_verify_options *options_ = structs(a, "options", &VERIFY_OPTIONS_STRUCT);
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  int64_t harmonics_n = room(a, "harmonics");
  double *harmonics_ = array(harmonics_n, 2 * sizeof(double));
  int64_t harmonics_len_ = whole(a, "harmonics_len");
  int64_t errors_n = room(a, "errors");
  double *errors_ = array(errors_n, 1 * sizeof(double));
  int64_t errors_len_ = whole(a, "errors_len");
  hbvib_verification out_;
  hbvib_verification_init(&out_, sizeof out_);
  hbvib_status status_ = hbvib_verify(model_, branch_, point_, options_, hooks_, harmonics_, harmonics_len_, errors_, errors_len_, &out_);
  give_complexes(a, harmonics_, harmonics_n);
  give_reals(a, errors_, errors_n);
  give_struct(a, &out_, &VERIFICATION_STRUCT);
  finish(a, status_);
}

static void call_floquet(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t point_ = whole(a, "point");
  const hbvib_floquet_options *options_ = structs(a, "options", &FLOQUET_OPTIONS_STRUCT);
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  int64_t multipliers_n = room(a, "multipliers");
  double *multipliers_ = array(multipliers_n, 2 * sizeof(double));
  int64_t multipliers_len_ = whole(a, "multipliers_len");
  int64_t classes_n = room(a, "classes");
  int64_t *classes_ = array(classes_n, 1 * sizeof(int64_t));
  int64_t classes_len_ = whole(a, "classes_len");
  hbvib_floquet_info out_;
  hbvib_floquet_info_init(&out_, sizeof out_);
  hbvib_status status_ = hbvib_floquet(model_, branch_, point_, options_, hooks_, multipliers_, multipliers_len_, classes_, classes_len_, &out_);
  give_complexes(a, multipliers_, multipliers_n);
  give_wholes(a, classes_, classes_n);
  give_struct(a, &out_, &FLOQUET_INFO_STRUCT);
  finish(a, status_);
}

static void call_smallest_kick(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t point_ = whole(a, "point");
  const hbvib_branch *saddle_branch_ = handle(a, "saddle_branch");
  int64_t saddle_ = whole(a, "saddle");
  int64_t dof_ = whole(a, "dof");
  int64_t phases_ = whole(a, "phases");
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  hbvib_kick out_;
  hbvib_kick_init(&out_, sizeof out_);
  hbvib_status status_ = hbvib_smallest_kick(model_, branch_, point_, saddle_branch_, saddle_, dof_, phases_, hooks_, &out_);
  give_struct(a, &out_, &KICK_STRUCT);
  finish(a, status_);
}

static void call_branch_bifurcations(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t capacity_ = whole(a, "capacity");
  int64_t omega_n = room(a, "omega");
  double *omega_ = array(omega_n, 1 * sizeof(double));
  int64_t amplitude_n = room(a, "amplitude");
  double *amplitude_ = array(amplitude_n, 1 * sizeof(double));
  int64_t kind_n = room(a, "kind");
  int64_t *kind_ = array(kind_n, 1 * sizeof(int64_t));
  int64_t point_n = room(a, "point");
  int64_t *point_ = array(point_n, 1 * sizeof(int64_t));
  int64_t unstable_before_n = room(a, "unstable_before");
  int64_t *unstable_before_ = array(unstable_before_n, 1 * sizeof(int64_t));
  int64_t unstable_after_n = room(a, "unstable_after");
  int64_t *unstable_after_ = array(unstable_after_n, 1 * sizeof(int64_t));
  int64_t count_ = 0;
  hbvib_status status_ = hbvib_branch_bifurcations(branch_, capacity_, omega_, amplitude_, kind_, point_, unstable_before_, unstable_after_, &count_);
  give_reals(a, omega_, omega_n);
  give_reals(a, amplitude_, amplitude_n);
  give_wholes(a, kind_, kind_n);
  give_wholes(a, point_, point_n);
  give_wholes(a, unstable_before_, unstable_before_n);
  give_wholes(a, unstable_after_, unstable_after_n);
  give_number(a, (double)count_);
  finish(a, status_);
}

static void call_branch_limit_cycles(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t capacity_ = whole(a, "capacity");
  int64_t omega_n = room(a, "omega");
  double *omega_ = array(omega_n, 1 * sizeof(double));
  int64_t log10_amplitude_n = room(a, "log10_amplitude");
  double *log10_amplitude_ = array(log10_amplitude_n, 1 * sizeof(double));
  int64_t slope_n = room(a, "slope");
  double *slope_ = array(slope_n, 1 * sizeof(double));
  int64_t point_n = room(a, "point");
  int64_t *point_ = array(point_n, 1 * sizeof(int64_t));
  int64_t count_ = 0;
  hbvib_status status_ = hbvib_branch_limit_cycles(branch_, capacity_, omega_, log10_amplitude_, slope_, point_, &count_);
  give_reals(a, omega_, omega_n);
  give_reals(a, log10_amplitude_, log10_amplitude_n);
  give_reals(a, slope_, slope_n);
  give_wholes(a, point_, point_n);
  give_number(a, (double)count_);
  finish(a, status_);
}

static void call_sensitivity(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t point_ = whole(a, "point");
  int32_t of_ = (int32_t)whole32(a, "of");
  const hbvib_parameter *parameters_ = structs(a, "parameters", &PARAMETER_STRUCT);
  int64_t count_ = whole(a, "count");
  int64_t derivatives_n = room(a, "derivatives");
  double *derivatives_ = array(derivatives_n, 1 * sizeof(double));
  int64_t derivatives_len_ = whole(a, "derivatives_len");
  int64_t reasons_n = room(a, "reasons");
  int64_t *reasons_ = array(reasons_n, 1 * sizeof(int64_t));
  int64_t onset_ = 0;
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  hbvib_status status_ = hbvib_sensitivity(model_, branch_, point_, of_, parameters_, count_, derivatives_, derivatives_len_, reasons_, &onset_, hooks_);
  give_reals(a, derivatives_, derivatives_n);
  give_wholes(a, reasons_, reasons_n);
  give_number(a, (double)onset_);
  finish(a, status_);
}

static void call_response_sensitivity(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t point_ = whole(a, "point");
  const hbvib_response *response_ = structs(a, "response", &RESPONSE_STRUCT);
  const hbvib_parameter *parameters_ = structs(a, "parameters", &PARAMETER_STRUCT);
  int64_t count_ = whole(a, "count");
  int64_t derivatives_n = room(a, "derivatives");
  double *derivatives_ = array(derivatives_n, 2 * sizeof(double));
  int64_t derivatives_len_ = whole(a, "derivatives_len");
  int64_t reasons_n = room(a, "reasons");
  int64_t *reasons_ = array(reasons_n, 1 * sizeof(int64_t));
  int64_t onset_ = 0;
  int64_t value_n = room(a, "value");
  double *value_ = array(value_n, 1 * sizeof(double));
  int64_t by_omega_n = room(a, "by_omega");
  double *by_omega_ = array(by_omega_n, 1 * sizeof(double));
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  hbvib_status status_ = hbvib_response_sensitivity(model_, branch_, point_, response_, parameters_, count_, derivatives_, derivatives_len_, reasons_, &onset_, value_, by_omega_, hooks_);
  give_complexes(a, derivatives_, derivatives_n);
  give_wholes(a, reasons_, reasons_n);
  give_number(a, (double)onset_);
  give_reals(a, value_, value_n);
  give_reals(a, by_omega_, by_omega_n);
  finish(a, status_);
}

static void call_parameter_response(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  const hbvib_solver_options *solver_ = structs(a, "solver", &SOLVER_OPTIONS_STRUCT);
  const hbvib_parameter_options *options_ = structs(a, "options", &PARAMETER_OPTIONS_STRUCT);
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  hbvib_branch *out_ = NULL;
  hbvib_status status_ = hbvib_parameter_response(model_, solver_, options_, hooks_, &out_);
  give_branch(a, out_);
  finish(a, status_);
}

static void call_branch_optima(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t capacity_ = whole(a, "capacity");
  int64_t parameter_n = room(a, "parameter");
  double *parameter_ = array(parameter_n, 1 * sizeof(double));
  int64_t amplitude_n = room(a, "amplitude");
  double *amplitude_ = array(amplitude_n, 1 * sizeof(double));
  int64_t maximum_n = room(a, "maximum");
  int64_t *maximum_ = array(maximum_n, 1 * sizeof(int64_t));
  int64_t point_n = room(a, "point");
  int64_t *point_ = array(point_n, 1 * sizeof(int64_t));
  int64_t count_ = 0;
  hbvib_status status_ = hbvib_branch_optima(branch_, capacity_, parameter_, amplitude_, maximum_, point_, &count_);
  give_reals(a, parameter_, parameter_n);
  give_reals(a, amplitude_, amplitude_n);
  give_wholes(a, maximum_, maximum_n);
  give_wholes(a, point_, point_n);
  give_number(a, (double)count_);
  finish(a, status_);
}

static void call_branch_turns(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t capacity_ = whole(a, "capacity");
  int64_t parameter_n = room(a, "parameter");
  double *parameter_ = array(parameter_n, 1 * sizeof(double));
  int64_t omega_n = room(a, "omega");
  double *omega_ = array(omega_n, 1 * sizeof(double));
  int64_t amplitude_n = room(a, "amplitude");
  double *amplitude_ = array(amplitude_n, 1 * sizeof(double));
  int64_t maximum_n = room(a, "maximum");
  int64_t *maximum_ = array(maximum_n, 1 * sizeof(int64_t));
  int64_t point_n = room(a, "point");
  int64_t *point_ = array(point_n, 1 * sizeof(int64_t));
  int64_t count_ = 0;
  hbvib_status status_ = hbvib_branch_turns(branch_, capacity_, parameter_, omega_, amplitude_, maximum_, point_, &count_);
  give_reals(a, parameter_, parameter_n);
  give_reals(a, omega_, omega_n);
  give_reals(a, amplitude_, amplitude_n);
  give_wholes(a, maximum_, maximum_n);
  give_wholes(a, point_, point_n);
  give_number(a, (double)count_);
  finish(a, status_);
}

static void call_branch_higher_peaks(Call *a) {
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t capacity_ = whole(a, "capacity");
  int64_t parameter_n = room(a, "parameter");
  double *parameter_ = array(parameter_n, 1 * sizeof(double));
  int64_t omega_n = room(a, "omega");
  double *omega_ = array(omega_n, 1 * sizeof(double));
  int64_t amplitude_n = room(a, "amplitude");
  double *amplitude_ = array(amplitude_n, 1 * sizeof(double));
  int64_t point_n = room(a, "point");
  int64_t *point_ = array(point_n, 1 * sizeof(int64_t));
  int64_t count_ = 0;
  hbvib_status status_ = hbvib_branch_higher_peaks(branch_, capacity_, parameter_, omega_, amplitude_, point_, &count_);
  give_reals(a, parameter_, parameter_n);
  give_reals(a, omega_, omega_n);
  give_reals(a, amplitude_, amplitude_n);
  give_wholes(a, point_, point_n);
  give_number(a, (double)count_);
  finish(a, status_);
}

static void call_batch_solve(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  const hbvib_solver_options *solver_ = structs(a, "solver", &SOLVER_OPTIONS_STRUCT);
  const hbvib_batch_options *options_ = structs(a, "options", &BATCH_OPTIONS_STRUCT);
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  const hbvib_parameter *parameters_ = structs(a, "parameters", &PARAMETER_STRUCT);
  int64_t count_ = whole(a, "count");
  int64_t designs_ = whole(a, "designs");
  const double *values_ = reals(a, "values");
  hbvib_batch *out_ = NULL;
  hbvib_status status_ = hbvib_batch_solve(model_, solver_, options_, hooks_, parameters_, count_, designs_, values_, &out_);
  give_batch(a, out_);
  finish(a, status_);
}

static void call_batch_free(Call *a) {
  hbvib_batch *batch_ = handle(a, "batch");
  hbvib_status status_ = hbvib_batch_free(batch_);
  finish(a, status_);
}

static void call_batch_designs(Call *a) {
  const hbvib_batch *batch_ = handle(a, "batch");
  double result_ = (double)hbvib_batch_designs(batch_);
  give_count(a, result_);
}

static void call_batch_peaks(Call *a) {
  const hbvib_batch *batch_ = handle(a, "batch");
  int64_t capacity_ = whole(a, "capacity");
  int64_t peak_amplitude_n = room(a, "peak_amplitude");
  double *peak_amplitude_ = array(peak_amplitude_n, 1 * sizeof(double));
  int64_t peak_omega_n = room(a, "peak_omega");
  double *peak_omega_ = array(peak_omega_n, 1 * sizeof(double));
  int64_t statuses_n = room(a, "statuses");
  int64_t *statuses_ = array(statuses_n, 1 * sizeof(int64_t));
  int64_t points_n = room(a, "points");
  int64_t *points_ = array(points_n, 1 * sizeof(int64_t));
  hbvib_status status_ = hbvib_batch_peaks(batch_, capacity_, peak_amplitude_, peak_omega_, statuses_, points_);
  give_reals(a, peak_amplitude_, peak_amplitude_n);
  give_reals(a, peak_omega_, peak_omega_n);
  give_wholes(a, statuses_, statuses_n);
  give_wholes(a, points_, points_n);
  finish(a, status_);
}

static void call_batch_response_peaks(Call *a) {
  const hbvib_batch *batch_ = handle(a, "batch");
  int64_t response_ = whole(a, "response");
  int64_t capacity_ = whole(a, "capacity");
  int64_t amplitude_n = room(a, "amplitude");
  double *amplitude_ = array(amplitude_n, 1 * sizeof(double));
  int64_t omega_n = room(a, "omega");
  double *omega_ = array(omega_n, 1 * sizeof(double));
  hbvib_status status_ = hbvib_batch_response_peaks(batch_, response_, capacity_, amplitude_, omega_);
  give_reals(a, amplitude_, amplitude_n);
  give_reals(a, omega_, omega_n);
  finish(a, status_);
}

static void call_batch_response_ends(Call *a) {
  const hbvib_batch *batch_ = handle(a, "batch");
  int64_t response_ = whole(a, "response");
  int64_t capacity_ = whole(a, "capacity");
  int64_t amplitude_n = room(a, "amplitude");
  double *amplitude_ = array(amplitude_n, 1 * sizeof(double));
  int64_t omega_n = room(a, "omega");
  double *omega_ = array(omega_n, 1 * sizeof(double));
  hbvib_status status_ = hbvib_batch_response_ends(batch_, response_, capacity_, amplitude_, omega_);
  give_reals(a, amplitude_, amplitude_n);
  give_reals(a, omega_, omega_n);
  finish(a, status_);
}

static void call_batch_status(Call *a) {
  const hbvib_batch *batch_ = handle(a, "batch");
  int64_t design_ = whole(a, "design");
  hbvib_status status_ = hbvib_batch_status(batch_, design_);
  finish(a, status_);
}

static void call_batch_branch(Call *a) {
  hbvib_batch *batch_ = handle(a, "batch");
  int64_t design_ = whole(a, "design");
  hbvib_branch *out_ = NULL;
  hbvib_status status_ = hbvib_batch_branch(batch_, design_, &out_);
  give_branch(a, out_);
  finish(a, status_);
}

static void call_wheel_peaks(Call *a) {
  const hbvib_model *wheel_ = handle(a, "wheel");
  const hbvib_model *cyclic_ = handle(a, "cyclic");
  const hbvib_response *blade_ = structs(a, "blade", &RESPONSE_STRUCT);
  const hbvib_solver_options *solver_ = structs(a, "solver", &SOLVER_OPTIONS_STRUCT);
  double omega_start_ = real(a, "omega_start");
  double omega_stop_ = real(a, "omega_stop");
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  int64_t capacity_ = whole(a, "capacity");
  int64_t amplitude_n = room(a, "amplitude");
  double *amplitude_ = array(amplitude_n, 1 * sizeof(double));
  int64_t omega_n = room(a, "omega");
  double *omega_ = array(omega_n, 1 * sizeof(double));
  int64_t error_n = room(a, "error");
  double *error_ = array(error_n, 1 * sizeof(double));
  int64_t count_ = 0;
  hbvib_wheel_info info_;
  hbvib_wheel_info_init(&info_, sizeof info_);
  hbvib_branch *out_ = NULL;
  hbvib_status status_ = hbvib_wheel_peaks(wheel_, cyclic_, blade_, solver_, omega_start_, omega_stop_, hooks_, capacity_, amplitude_, omega_, error_, &count_, &info_, &out_);
  give_reals(a, amplitude_, amplitude_n);
  give_reals(a, omega_, omega_n);
  give_reals(a, error_, error_n);
  give_number(a, (double)count_);
  give_struct(a, &info_, &WHEEL_INFO_STRUCT);
  give_branch(a, out_);
  finish(a, status_);
}

static void call_wheel_identify(Call *a) {
  const hbvib_model *cyclic_ = handle(a, "cyclic");
  int32_t kind_ = (int32_t)whole32(a, "kind");
  int64_t n_dofs_ = whole(a, "n_dofs");
  const int64_t *dofs_ = wholes(a, "dofs");
  const hbvib_matrix *direction_ = structs(a, "direction", &MATRIX_STRUCT);
  int32_t contacts_ = (int32_t)whole32(a, "contacts");
  int64_t families_ = whole(a, "families");
  int64_t n_points_ = whole(a, "n_points");
  const int64_t *points_ = wholes(a, "points");
  int64_t n_modes_ = whole(a, "n_modes");
  const double *omega_ = reals(a, "omega");
  const double *sigma_omega_ = reals(a, "sigma_omega");
  const double *shapes_ = complexes(a, "shapes");
  const double *sigma_shape_ = reals(a, "sigma_shape");
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  int64_t sectors_ = whole(a, "sectors");
  int64_t delta_n = room(a, "delta");
  double *delta_ = array(delta_n, 1 * sizeof(double));
  int64_t covariance_n = room(a, "covariance");
  double *covariance_ = array(covariance_n, 1 * sizeof(double));
  int64_t chi2_n = room(a, "chi2");
  double *chi2_ = array(chi2_n, 1 * sizeof(double));
  int64_t degrees_ = 0;
  hbvib_status status_ = hbvib_wheel_identify(cyclic_, kind_, n_dofs_, dofs_, direction_, contacts_, families_, n_points_, points_, n_modes_, omega_, sigma_omega_, shapes_, sigma_shape_, hooks_, sectors_, delta_, covariance_, chi2_, &degrees_);
  give_reals(a, delta_, delta_n);
  give_reals(a, covariance_, covariance_n);
  give_reals(a, chi2_, chi2_n);
  give_number(a, (double)degrees_);
  finish(a, status_);
}

static void call_wheel_blade_modes(Call *a) {
  const hbvib_model *cyclic_ = handle(a, "cyclic");
  int64_t n_dofs_ = whole(a, "n_dofs");
  const int64_t *dofs_ = wholes(a, "dofs");
  int64_t modes_ = whole(a, "modes");
  int64_t families_ = whole(a, "families");
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  int64_t n_points_ = whole(a, "n_points");
  const int64_t *points_ = wholes(a, "points");
  int64_t weights_len_ = whole(a, "weights_len");
  int64_t weights_n = room(a, "weights");
  double *weights_ = array(weights_n, 1 * sizeof(double));
  int64_t ndof_ = whole(a, "ndof");
  int64_t numbers_ = 0;
  int64_t first_ = 0;
  int64_t left_out_n = room(a, "left_out");
  double *left_out_ = array(left_out_n, 1 * sizeof(double));
  hbvib_model *out_ = NULL;
  hbvib_status status_ = hbvib_wheel_blade_modes(cyclic_, n_dofs_, dofs_, modes_, families_, hooks_, n_points_, points_, weights_len_, weights_, ndof_, &numbers_, &first_, left_out_, &out_);
  give_reals(a, weights_, weights_n);
  give_number(a, (double)numbers_);
  give_number(a, (double)first_);
  give_reals(a, left_out_, left_out_n);
  give_model(a, out_);
  finish(a, status_);
}

static void call_branch_freedom(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t point_ = whole(a, "point");
  int64_t capacity_ = whole(a, "capacity");
  int64_t contact_n = room(a, "contact");
  int64_t *contact_ = array(contact_n, 1 * sizeof(int64_t));
  int64_t direction_n = room(a, "direction");
  int64_t *direction_ = array(direction_n, 1 * sizeof(int64_t));
  int64_t place_n = room(a, "place");
  double *place_ = array(place_n, 1 * sizeof(double));
  int64_t derivative_n = room(a, "derivative");
  double *derivative_ = array(derivative_n, 1 * sizeof(double));
  int64_t count_ = 0;
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  hbvib_status status_ = hbvib_branch_freedom(model_, branch_, point_, capacity_, contact_, direction_, place_, derivative_, &count_, hooks_);
  give_wholes(a, contact_, contact_n);
  give_wholes(a, direction_, direction_n);
  give_reals(a, place_, place_n);
  give_reals(a, derivative_, derivative_n);
  give_number(a, (double)count_);
  finish(a, status_);
}

static void call_band(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t point_ = whole(a, "point");
  const hbvib_solver_options *solver_ = structs(a, "solver", &SOLVER_OPTIONS_STRUCT);
  const hbvib_band_options *options_ = structs(a, "options", &BAND_OPTIONS_STRUCT);
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  hbvib_band_info info_;
  hbvib_band_info_init(&info_, sizeof info_);
  int64_t capacity_ = whole(a, "capacity");
  int64_t contact_n = room(a, "contact");
  int64_t *contact_ = array(contact_n, 1 * sizeof(int64_t));
  int64_t direction_n = room(a, "direction");
  int64_t *direction_ = array(direction_n, 1 * sizeof(int64_t));
  int64_t lower_place_n = room(a, "lower_place");
  double *lower_place_ = array(lower_place_n, 1 * sizeof(double));
  int64_t upper_place_n = room(a, "upper_place");
  double *upper_place_ = array(upper_place_n, 1 * sizeof(double));
  int64_t states_capacity_ = whole(a, "states_capacity");
  int64_t states_n = room(a, "states");
  double *states_ = array(states_n, 1 * sizeof(double));
  hbvib_branch *lower_ = NULL;
  hbvib_branch *upper_ = NULL;
  hbvib_status status_ = hbvib_band(model_, branch_, point_, solver_, options_, hooks_, &info_, capacity_, contact_, direction_, lower_place_, upper_place_, states_capacity_, states_, &lower_, &upper_);
  give_struct(a, &info_, &BAND_INFO_STRUCT);
  give_wholes(a, contact_, contact_n);
  give_wholes(a, direction_, direction_n);
  give_reals(a, lower_place_, lower_place_n);
  give_reals(a, upper_place_, upper_place_n);
  give_reals(a, states_, states_n);
  give_branch(a, lower_);
  give_branch(a, upper_);
  finish(a, status_);
}

static void call_band_curve(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t points_len_ = whole(a, "points_len");
  const int64_t *points_ = wholes(a, "points");
  const hbvib_solver_options *solver_ = structs(a, "solver", &SOLVER_OPTIONS_STRUCT);
  const hbvib_band_options *options_ = structs(a, "options", &BAND_OPTIONS_STRUCT);
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  int64_t capacity_ = whole(a, "capacity");
  int64_t omega_n = room(a, "omega");
  double *omega_ = array(omega_n, 1 * sizeof(double));
  int64_t lower_n = room(a, "lower");
  double *lower_ = array(lower_n, 1 * sizeof(double));
  int64_t upper_n = room(a, "upper");
  double *upper_ = array(upper_n, 1 * sizeof(double));
  int64_t sliders_n = room(a, "sliders");
  int64_t *sliders_ = array(sliders_n, 1 * sizeof(int64_t));
  int64_t complete_n = room(a, "complete");
  int64_t *complete_ = array(complete_n, 1 * sizeof(int64_t));
  int64_t count_ = 0;
  hbvib_status status_ = hbvib_band_curve(model_, branch_, points_len_, points_, solver_, options_, hooks_, capacity_, omega_, lower_, upper_, sliders_, complete_, &count_);
  give_reals(a, omega_, omega_n);
  give_reals(a, lower_, lower_n);
  give_reals(a, upper_, upper_n);
  give_wholes(a, sliders_, sliders_n);
  give_wholes(a, complete_, complete_n);
  give_number(a, (double)count_);
  finish(a, status_);
}

static void call_mode_band(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  const hbvib_branch *branch_ = handle(a, "branch");
  int64_t point_ = whole(a, "point");
  const hbvib_solver_options *solver_ = structs(a, "solver", &SOLVER_OPTIONS_STRUCT);
  const hbvib_mode_options *mode_ = structs(a, "mode", &MODE_OPTIONS_STRUCT);
  int32_t of_ = (int32_t)whole32(a, "of");
  int64_t contacts_len_ = whole(a, "contacts_len");
  const int64_t *contacts_ = wholes(a, "contacts");
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  hbvib_band_info info_;
  hbvib_band_info_init(&info_, sizeof info_);
  int64_t capacity_ = whole(a, "capacity");
  int64_t contact_n = room(a, "contact");
  int64_t *contact_ = array(contact_n, 1 * sizeof(int64_t));
  int64_t direction_n = room(a, "direction");
  int64_t *direction_ = array(direction_n, 1 * sizeof(int64_t));
  int64_t ends_n = room(a, "ends");
  double *ends_ = array(ends_n, 1 * sizeof(double));
  int64_t states_capacity_ = whole(a, "states_capacity");
  int64_t states_n = room(a, "states");
  double *states_ = array(states_n, 1 * sizeof(double));
  hbvib_status status_ = hbvib_mode_band(model_, branch_, point_, solver_, mode_, of_, contacts_len_, contacts_, hooks_, &info_, capacity_, contact_, direction_, ends_, states_capacity_, states_);
  give_struct(a, &info_, &BAND_INFO_STRUCT);
  give_wholes(a, contact_, contact_n);
  give_wholes(a, direction_, direction_n);
  give_reals(a, ends_, ends_n);
  give_reals(a, states_, states_n);
  finish(a, status_);
}

static void call_static_history(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  const hbvib_solver_options *solver_ = structs(a, "solver", &SOLVER_OPTIONS_STRUCT);
  int64_t steps_ = whole(a, "steps");
  const double *factors_ = reals(a, "factors");
  const double *speeds_ = reals(a, "speeds");
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  int64_t motion_n = room(a, "motion");
  double *motion_ = array(motion_n, 1 * sizeof(double));
  int64_t motion_len_ = whole(a, "motion_len");
  int64_t places_n = room(a, "places");
  double *places_ = array(places_n, 1 * sizeof(double));
  int64_t places_len_ = whole(a, "places_len");
  int64_t forces_n = room(a, "forces");
  double *forces_ = array(forces_n, 1 * sizeof(double));
  int64_t forces_len_ = whole(a, "forces_len");
  hbvib_status status_ = hbvib_static_history(model_, solver_, steps_, factors_, speeds_, hooks_, motion_, motion_len_, places_, places_len_, forces_, forces_len_);
  give_reals(a, motion_, motion_n);
  give_reals(a, places_, places_n);
  give_reals(a, forces_, forces_n);
  finish(a, status_);
}

static void call_life(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  const hbvib_solver_options *solver_ = structs(a, "solver", &SOLVER_OPTIONS_STRUCT);
  const hbvib_life_options *options_ = structs(a, "options", &LIFE_OPTIONS_STRUCT);
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  int64_t n_ = whole(a, "n");
  const double *cycles_ = reals(a, "cycles");
  int64_t depths_n = room(a, "depths");
  double *depths_ = array(depths_n, 1 * sizeof(double));
  int64_t loads_n = room(a, "loads");
  double *loads_ = array(loads_n, 1 * sizeof(double));
  int64_t works_n = room(a, "works");
  double *works_ = array(works_n, 1 * sizeof(double));
  int64_t amplitude_n = room(a, "amplitude");
  double *amplitude_ = array(amplitude_n, 1 * sizeof(double));
  int64_t omega_n = room(a, "omega");
  double *omega_ = array(omega_n, 1 * sizeof(double));
  int64_t capacity_ = whole(a, "capacity");
  int64_t event_cycles_n = room(a, "event_cycles");
  double *event_cycles_ = array(event_cycles_n, 1 * sizeof(double));
  int64_t event_kind_n = room(a, "event_kind");
  int64_t *event_kind_ = array(event_kind_n, 1 * sizeof(int64_t));
  int64_t event_contact_n = room(a, "event_contact");
  int64_t *event_contact_ = array(event_contact_n, 1 * sizeof(int64_t));
  int64_t events_ = 0;
  hbvib_life_info info_;
  hbvib_life_info_init(&info_, sizeof info_);
  hbvib_status status_ = hbvib_life(model_, solver_, options_, hooks_, n_, cycles_, depths_, loads_, works_, amplitude_, omega_, capacity_, event_cycles_, event_kind_, event_contact_, &events_, &info_);
  give_reals(a, depths_, depths_n);
  give_reals(a, loads_, loads_n);
  give_reals(a, works_, works_n);
  give_reals(a, amplitude_, amplitude_n);
  give_reals(a, omega_, omega_n);
  give_reals(a, event_cycles_, event_cycles_n);
  give_wholes(a, event_kind_, event_kind_n);
  give_wholes(a, event_contact_, event_contact_n);
  give_number(a, (double)events_);
  give_struct(a, &info_, &LIFE_INFO_STRUCT);
  finish(a, status_);
}

static void call_best_load_for_life(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  const hbvib_solver_options *solver_ = structs(a, "solver", &SOLVER_OPTIONS_STRUCT);
  const hbvib_life_options *options_ = structs(a, "options", &LIFE_OPTIONS_STRUCT);
  double cycles_ = real(a, "cycles");
  double factor_low_ = real(a, "factor_low");
  double factor_high_ = real(a, "factor_high");
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  hbvib_best_load out_;
  hbvib_best_load_init(&out_, sizeof out_);
  hbvib_status status_ = hbvib_best_load_for_life(model_, solver_, options_, cycles_, factor_low_, factor_high_, hooks_, &out_);
  give_struct(a, &out_, &BEST_LOAD_STRUCT);
  finish(a, status_);
}

static void call_fit(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  const hbvib_solver_options *solver_ = structs(a, "solver", &SOLVER_OPTIONS_STRUCT);
  const hbvib_fit_options *options_ = structs(a, "options", &FIT_OPTIONS_STRUCT);
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  const hbvib_parameter *parameters_ = structs(a, "parameters", &PARAMETER_STRUCT);
  int64_t count_ = whole(a, "count");
  const hbvib_unknown *unknowns_ = structs(a, "unknowns", &UNKNOWN_STRUCT);
  const hbvib_data *data_ = structs(a, "data", &DATA_STRUCT);
  int64_t data_len_ = whole(a, "data_len");
  hbvib_fit_info info_;
  hbvib_fit_info_init(&info_, sizeof info_);
  int64_t theta_n = room(a, "theta");
  double *theta_ = array(theta_n, 1 * sizeof(double));
  int64_t covariance_n = room(a, "covariance");
  double *covariance_ = array(covariance_n, 1 * sizeof(double));
  int64_t residuals_len_ = whole(a, "residuals_len");
  int64_t residuals_n = room(a, "residuals");
  double *residuals_ = array(residuals_n, 1 * sizeof(double));
  int64_t values_n = room(a, "values");
  double *values_ = array(values_n, 1 * sizeof(double));
  hbvib_model *out_ = NULL;
  hbvib_status status_ = hbvib_fit(model_, solver_, options_, hooks_, parameters_, count_, unknowns_, data_, data_len_, &info_, theta_, covariance_, residuals_len_, residuals_, values_, &out_);
  give_struct(a, &info_, &FIT_INFO_STRUCT);
  give_reals(a, theta_, theta_n);
  give_reals(a, covariance_, covariance_n);
  give_reals(a, residuals_, residuals_n);
  give_reals(a, values_, values_n);
  give_model(a, out_);
  finish(a, status_);
}

static void call_predict(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  const hbvib_solver_options *solver_ = structs(a, "solver", &SOLVER_OPTIONS_STRUCT);
  const hbvib_data *wanted_ = structs(a, "wanted", &DATA_STRUCT);
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  const hbvib_parameter *parameters_ = structs(a, "parameters", &PARAMETER_STRUCT);
  int64_t count_ = whole(a, "count");
  const double *theta_ = reals(a, "theta");
  const double *covariance_ = reals(a, "covariance");
  int64_t capacity_ = whole(a, "capacity");
  int64_t values_n = room(a, "values");
  double *values_ = array(values_n, 1 * sizeof(double));
  int64_t sigma_n = room(a, "sigma");
  double *sigma_ = array(sigma_n, 1 * sizeof(double));
  int64_t shift_n = room(a, "shift");
  double *shift_ = array(shift_n, 1 * sizeof(double));
  hbvib_status status_ = hbvib_predict(model_, solver_, wanted_, hooks_, parameters_, count_, theta_, covariance_, capacity_, values_, sigma_, shift_);
  give_reals(a, values_, values_n);
  give_reals(a, sigma_, sigma_n);
  give_reals(a, shift_, shift_n);
  finish(a, status_);
}

static void call_fit_profile(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  const hbvib_solver_options *solver_ = structs(a, "solver", &SOLVER_OPTIONS_STRUCT);
  const hbvib_fit_options *options_ = structs(a, "options", &FIT_OPTIONS_STRUCT);
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  const hbvib_parameter *parameters_ = structs(a, "parameters", &PARAMETER_STRUCT);
  int64_t count_ = whole(a, "count");
  const hbvib_unknown *unknowns_ = structs(a, "unknowns", &UNKNOWN_STRUCT);
  const hbvib_data *data_ = structs(a, "data", &DATA_STRUCT);
  int64_t data_len_ = whole(a, "data_len");
  const double *theta_ = reals(a, "theta");
  int64_t number_ = whole(a, "number");
  int64_t values_len_ = whole(a, "values_len");
  const double *values_ = reals(a, "values");
  double rise_ = real(a, "rise");
  hbvib_fit_profile_info info_;
  hbvib_fit_profile_info_init(&info_, sizeof info_);
  int64_t loss_n = room(a, "loss");
  double *loss_ = array(loss_n, 1 * sizeof(double));
  int64_t profiled_n = room(a, "profiled");
  double *profiled_ = array(profiled_n, 1 * sizeof(double));
  hbvib_status status_ = hbvib_fit_profile(model_, solver_, options_, hooks_, parameters_, count_, unknowns_, data_, data_len_, theta_, number_, values_len_, values_, rise_, &info_, loss_, profiled_);
  give_struct(a, &info_, &FIT_PROFILE_INFO_STRUCT);
  give_reals(a, loss_, loss_n);
  give_reals(a, profiled_, profiled_n);
  finish(a, status_);
}

static void call_contact_evaluate(Call *a) {
  const hbvib_contact *c_ = structs(a, "c", &CONTACT_STRUCT);
  int64_t harmonics_ = whole(a, "harmonics");
  int64_t samples_ = whole(a, "samples");
  double omega_ = real(a, "omega");
  const double *motion_ = complexes(a, "motion");
  int64_t motion_len_ = whole(a, "motion_len");
  int64_t force_n = room(a, "force");
  double *force_ = array(force_n, 2 * sizeof(double));
  int64_t force_len_ = whole(a, "force_len");
  int64_t jac_n = room(a, "jac");
  double *jac_ = array(jac_n, 1 * sizeof(double));
  int64_t jac_len_ = whole(a, "jac_len");
  hbvib_status status_ = hbvib_contact_evaluate(c_, harmonics_, samples_, omega_, motion_, motion_len_, force_, force_len_, jac_, jac_len_);
  give_complexes(a, force_, force_n);
  give_reals(a, jac_, jac_n);
  finish(a, status_);
}

static void call_contact_evaluate_with_hooks(Call *a) {
  const hbvib_contact *c_ = structs(a, "c", &CONTACT_STRUCT);
  int64_t harmonics_ = whole(a, "harmonics");
  int64_t samples_ = whole(a, "samples");
  double omega_ = real(a, "omega");
  const double *motion_ = complexes(a, "motion");
  int64_t motion_len_ = whole(a, "motion_len");
  int64_t force_n = room(a, "force");
  double *force_ = array(force_n, 2 * sizeof(double));
  int64_t force_len_ = whole(a, "force_len");
  int64_t jac_n = room(a, "jac");
  double *jac_ = array(jac_n, 1 * sizeof(double));
  int64_t jac_len_ = whole(a, "jac_len");
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  hbvib_status status_ = hbvib_contact_evaluate_with_hooks(c_, harmonics_, samples_, omega_, motion_, motion_len_, force_, force_len_, jac_, jac_len_, hooks_);
  give_complexes(a, force_, force_n);
  give_reals(a, jac_, jac_n);
  finish(a, status_);
}

static void call_forced_residual(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  const hbvib_solver_options *solver_ = structs(a, "solver", &SOLVER_OPTIONS_STRUCT);
  double omega_ = real(a, "omega");
  const double *x_ = complexes(a, "x");
  int64_t x_len_ = whole(a, "x_len");
  int64_t r_n = room(a, "r");
  double *r_ = array(r_n, 2 * sizeof(double));
  int64_t r_len_ = whole(a, "r_len");
  int64_t jac_n = room(a, "jac");
  double *jac_ = array(jac_n, 1 * sizeof(double));
  int64_t jac_len_ = whole(a, "jac_len");
  int64_t d_omega_n = room(a, "d_omega");
  double *d_omega_ = array(d_omega_n, 2 * sizeof(double));
  int64_t d_omega_len_ = whole(a, "d_omega_len");
  hbvib_status status_ = hbvib_forced_residual(model_, solver_, omega_, x_, x_len_, r_, r_len_, jac_, jac_len_, d_omega_, d_omega_len_);
  give_complexes(a, r_, r_n);
  give_reals(a, jac_, jac_n);
  give_complexes(a, d_omega_, d_omega_n);
  finish(a, status_);
}

static void call_forced_residual_with_hooks(Call *a) {
  const hbvib_model *model_ = handle(a, "model");
  const hbvib_solver_options *solver_ = structs(a, "solver", &SOLVER_OPTIONS_STRUCT);
  double omega_ = real(a, "omega");
  const double *x_ = complexes(a, "x");
  int64_t x_len_ = whole(a, "x_len");
  int64_t r_n = room(a, "r");
  double *r_ = array(r_n, 2 * sizeof(double));
  int64_t r_len_ = whole(a, "r_len");
  int64_t jac_n = room(a, "jac");
  double *jac_ = array(jac_n, 1 * sizeof(double));
  int64_t jac_len_ = whole(a, "jac_len");
  int64_t d_omega_n = room(a, "d_omega");
  double *d_omega_ = array(d_omega_n, 2 * sizeof(double));
  int64_t d_omega_len_ = whole(a, "d_omega_len");
  const hbvib_hooks *hooks_ = hooks(a, "hooks");
  hbvib_status status_ = hbvib_forced_residual_with_hooks(model_, solver_, omega_, x_, x_len_, r_, r_len_, jac_, jac_len_, d_omega_, d_omega_len_, hooks_);
  give_complexes(a, r_, r_n);
  give_reals(a, jac_, jac_n);
  give_complexes(a, d_omega_, d_omega_n);
  finish(a, status_);
}

static void call_index_from_one(Call *a) {
  const char *name_ = text(a, "name");
  int64_t index_ = whole(a, "index");
  int64_t count_ = whole(a, "count");
  int64_t from_zero_ = 0;
  hbvib_status status_ = hbvib_index_from_one(name_, index_, count_, &from_zero_);
  give_number(a, (double)from_zero_);
  finish(a, status_);
}


static const Function FUNCTIONS[] = {
  {"version", call_version, 0},
  {"version_string", call_version_string, 0},
  {"status_name", call_status_name, 1},
  {"last_error", call_last_error, 0},
  {"last_error_argument", call_last_error_argument, 0},
  {"model_new", call_model_new, 1},
  {"model_clone", call_model_clone, 1},
  {"model_free", call_model_free, 1},
  {"model_dofs", call_model_dofs, 1},
  {"model_sectors", call_model_sectors, 1},
  {"model_contacts", call_model_contacts, 1},
  {"model_set_matrix", call_model_set_matrix, 3},
  {"model_fix", call_model_fix, 3},
  {"model_set_rayleigh", call_model_set_rayleigh, 3},
  {"model_add_springs", call_model_add_springs, 6},
  {"model_add_force", call_model_add_force, 5},
  {"model_clear_forces", call_model_clear_forces, 1},
  {"model_set_loss_factor", call_model_set_loss_factor, 2},
  {"model_set_modal_damping", call_model_set_modal_damping, 3},
  {"model_set_speed", call_model_set_speed, 2},
  {"model_set_speed_per_omega", call_model_set_speed_per_omega, 2},
  {"model_set_preload_at_speed", call_model_set_preload_at_speed, 4},
  {"model_add_centrifugal", call_model_add_centrifugal, 3},
  {"model_add_unbalance", call_model_add_unbalance, 5},
  {"model_wave", call_model_wave, 1},
  {"model_matrix", call_model_matrix, 7},
  {"model_springs", call_model_springs, 6},
  {"model_forces", call_model_forces, 6},
  {"model_save", call_model_save, 3},
  {"model_load", call_model_load, 2},
  {"cyclic_new", call_cyclic_new, 2},
  {"cyclic_set_coupling", call_cyclic_set_coupling, 3},
  {"cyclic_set_coupling_previous", call_cyclic_set_coupling_previous, 3},
  {"cyclic_set_diameter", call_cyclic_set_diameter, 4},
  {"cyclic_signed_diameter", call_cyclic_signed_diameter, 2},
  {"cyclic_set_wave", call_cyclic_set_wave, 2},
  {"cyclic_set_aero", call_cyclic_set_aero, 7},
  {"cyclic_aero", call_cyclic_aero, 7},
  {"cyclic_from_sector", call_cyclic_from_sector, 1},
  {"wheel_new", call_wheel_new, 1},
  {"wheel_mistune", call_wheel_mistune, 9},
  {"model_add_contact", call_model_add_contact, 2},
  {"model_set_preload", call_model_set_preload, 3},
  {"model_set_slider", call_model_set_slider, 4},
  {"model_add_jenkins", call_model_add_jenkins, 8},
  {"model_add_iwan", call_model_add_iwan, 9},
  {"model_add_table", call_model_add_table, 7},
  {"model_add_spring_damper", call_model_add_spring_damper, 8},
  {"model_add_polynomial", call_model_add_polynomial, 8},
  {"model_add_stiffness_tensors", call_model_add_stiffness_tensors, 5},
  {"model_add_patch", call_model_add_patch, 10},
  {"model_add_damper", call_model_add_damper, 2},
  {"model_contact", call_model_contact, 3},
  {"check_jacobian", call_check_jacobian, 5},
  {"forced_response", call_forced_response, 4},
  {"branch_children", call_branch_children, 1},
  {"branch_child", call_branch_child, 2},
  {"branch_descent", call_branch_descent, 1},
  {"branch_searched", call_branch_searched, 1},
  {"model_longer_period", call_model_longer_period, 2},
  {"branch_free", call_branch_free, 1},
  {"branch_points", call_branch_points, 1},
  {"branch_stored", call_branch_stored, 1},
  {"branch_status", call_branch_status, 1},
  {"branch_field", call_branch_field, 2},
  {"branch_stored_field", call_branch_stored_field, 2},
  {"branch_harmonics", call_branch_harmonics, 6},
  {"branch_harmonics_with_hooks", call_branch_harmonics_with_hooks, 7},
  {"branch_time_history", call_branch_time_history, 5},
  {"branch_time_history_with_hooks", call_branch_time_history_with_hooks, 6},
  {"branch_slip_fraction", call_branch_slip_fraction, 4},
  {"branch_peaks", call_branch_peaks, 5},
  {"branch_folds", call_branch_folds, 5},
  {"branch_at", call_branch_at, 5},
  {"branch_responses", call_branch_responses, 1},
  {"branch_response", call_branch_response, 3},
  {"branch_response_peaks", call_branch_response_peaks, 6},
  {"branch_response_kinks", call_branch_response_kinks, 7},
  {"branch_leading_response", call_branch_leading_response, 2},
  {"branch_read_responses", call_branch_read_responses, 10},
  {"response_of", call_response_of, 8},
  {"branch_reduction", call_branch_reduction, 1},
  {"branch_energy", call_branch_energy, 2},
  {"branch_energy_with_hooks", call_branch_energy_with_hooks, 3},
  {"branch_contact_loop", call_branch_contact_loop, 8},
  {"branch_contact_loop_with_hooks", call_branch_contact_loop_with_hooks, 9},
  {"branch_contact_summary", call_branch_contact_summary, 3},
  {"branch_contact_summary_with_hooks", call_branch_contact_summary_with_hooks, 4},
  {"linear_modes", call_linear_modes, 6},
  {"linear_modes_with_hooks", call_linear_modes_with_hooks, 7},
  {"damped_modes", call_damped_modes, 8},
  {"campbell", call_campbell, 10},
  {"campbell_crossings", call_campbell_crossings, 12},
  {"interference", call_interference, 9},
  {"nonlinear_mode", call_nonlinear_mode, 4},
  {"branch_mode_point", call_branch_mode_point, 2},
  {"branch_mode_info", call_branch_mode_info, 1},
  {"branch_synthesis", call_branch_synthesis, 7},
  {"branch_synthesis_with_hooks", call_branch_synthesis_with_hooks, 8},
  {"branch_synthesis_peaks", call_branch_synthesis_peaks, 11},
  {"branch_synthesis_peaks_with_hooks", call_branch_synthesis_peaks_with_hooks, 12},
  {"time_response", call_time_response, 7},
  {"time_sweep", call_time_sweep, 7},
  {"branch_run_up", call_branch_run_up, 9},
  {"branch_mission", call_branch_mission, 10},
  {"campbell_response", call_campbell_response, 12},
  {"verify", call_verify, 9},
  {"floquet", call_floquet, 9},
  {"smallest_kick", call_smallest_kick, 8},
  {"branch_bifurcations", call_branch_bifurcations, 8},
  {"branch_limit_cycles", call_branch_limit_cycles, 6},
  {"sensitivity", call_sensitivity, 10},
  {"response_sensitivity", call_response_sensitivity, 12},
  {"parameter_response", call_parameter_response, 4},
  {"branch_optima", call_branch_optima, 6},
  {"branch_turns", call_branch_turns, 7},
  {"branch_higher_peaks", call_branch_higher_peaks, 6},
  {"batch_solve", call_batch_solve, 8},
  {"batch_free", call_batch_free, 1},
  {"batch_designs", call_batch_designs, 1},
  {"batch_peaks", call_batch_peaks, 6},
  {"batch_response_peaks", call_batch_response_peaks, 5},
  {"batch_response_ends", call_batch_response_ends, 5},
  {"batch_status", call_batch_status, 2},
  {"batch_branch", call_batch_branch, 2},
  {"wheel_peaks", call_wheel_peaks, 11},
  {"wheel_identify", call_wheel_identify, 19},
  {"wheel_blade_modes", call_wheel_blade_modes, 12},
  {"branch_freedom", call_branch_freedom, 9},
  {"band", call_band, 13},
  {"band_curve", call_band_curve, 13},
  {"mode_band", call_mode_band, 15},
  {"static_history", call_static_history, 12},
  {"life", call_life, 15},
  {"best_load_for_life", call_best_load_for_life, 7},
  {"fit", call_fit, 14},
  {"predict", call_predict, 12},
  {"fit_profile", call_fit_profile, 16},
  {"contact_evaluate", call_contact_evaluate, 10},
  {"contact_evaluate_with_hooks", call_contact_evaluate_with_hooks, 11},
  {"forced_residual", call_forced_residual, 11},
  {"forced_residual_with_hooks", call_forced_residual_with_hooks, 12},
  {"index_from_one", call_index_from_one, 3},
};
/* END GENERATED */

static int named(const Call *a, const char *name, const mxArray *m) {
  char word[64];
  size_t i;
  if (mxGetString(m, word, sizeof word)) refuse(a, name, "is no constant");
  for (i = 0; word[i]; i++)
    if (word[i] >= 'a' && word[i] <= 'z') word[i] = (char)(word[i] - 'a' + 'A');
  for (i = 0; i < sizeof CONSTANTS / sizeof *CONSTANTS; i++)
    if (!strcmp(CONSTANTS[i].name, word)) return CONSTANTS[i].value;
  mexErrMsgIdAndTxt("hbvib:input", "%s: %s = '%s' is no constant of the library", a->name, name, word);
  return 0;
}

void mexFunction(int nlhs, mxArray *plhs[], int nrhs, const mxArray *prhs[]) {
  static const Function own = {"model_add_user_force", call_model_add_user_force, 3};
  Call a;
  char name[64];
  size_t i;
  int k;
  if (nrhs < 1 || !mxIsChar(prhs[0]) || mxGetString(prhs[0], name, sizeof name))
    mexErrMsgIdAndTxt("hbvib:input", "needs the name of a function of hbvib.h without hbvib_");
  if (!mexIsLocked()) mexLock(); /* `clear all` would take the library from under its objects */
  for (i = 0; i <= sizeof FUNCTIONS / sizeof *FUNCTIONS; i++) {
    const Function *f = i < sizeof FUNCTIONS / sizeof *FUNCTIONS ? &FUNCTIONS[i] : &own;
    if (strcmp(f->name, name)) continue;
    if (nrhs - 1 != f->inputs)
      mexErrMsgIdAndTxt("hbvib:input", "%s: has %d inputs, needs %d", name, nrhs - 1, f->inputs);
    memset(&a, 0, sizeof a);
    a.name = f->name;
    a.inputs = nrhs - 1;
    a.in = prhs + 1;
    current = &a;
    f->call(&a);
    current = NULL;
    for (k = 0; k < a.outputs; k++) {
      if (k < (nlhs > 0 ? nlhs : 1)) plhs[k] = a.out[k];
      else mxDestroyArray(a.out[k]);
    }
    if (nlhs > a.outputs) mexErrMsgIdAndTxt("hbvib:input", "%s: gives %d outputs", name, a.outputs);
    return;
  }
  mexErrMsgIdAndTxt("hbvib:input", "there is no function '%s'", name);
}
