/* Links against an installed library and solves the first response; packages are tried with it. */
#include <hbvib.h>
#include <math.h>
#include <stdio.h>

#define TRY(call)                                              \
  do {                                                         \
    if ((call) != HBVIB_OK) {                                  \
      fprintf(stderr, "%s\n", hbvib_last_error());             \
      return 1;                                                \
    }                                                          \
  } while (0)

int main(void) {
  const double one = 1;
  double omega = 0, amplitude = 0;
  int64_t id, point, count = 0;
  hbvib_model *model = NULL;
  hbvib_branch *branch = NULL;
  hbvib_matrix matrix;
  hbvib_contact contact;
  hbvib_forced_options range;
  TRY(hbvib_model_new(1, &model));
  TRY(hbvib_matrix_init(&matrix, sizeof matrix));
  matrix.rows = matrix.cols = 1;
  matrix.values = &one;
  TRY(hbvib_model_set_matrix(model, HBVIB_MASS, &matrix));
  TRY(hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &matrix));
  TRY(hbvib_model_set_rayleigh(model, 0, 0.02));
  TRY(hbvib_contact_init(&contact, sizeof contact));
  contact.kind = HBVIB_JENKINS;
  contact.dof_a[0] = 0;
  contact.kt = contact.preload = 1;
  contact.mu = 0.3;
  TRY(hbvib_model_add_contact(model, &contact, &id));
  TRY(hbvib_model_add_force(model, 0, 1, 0.2, 0));
  TRY(hbvib_forced_options_init(&range, sizeof range));
  range.omega_start = 0.8;
  range.omega_stop = 1.6;
  TRY(hbvib_forced_response(model, NULL, &range, NULL, &branch));
  TRY(hbvib_branch_peaks(branch, 1, &omega, &amplitude, &point, &count));
  printf("hbvib %s: resonance at %g\n", hbvib_version_string(), omega);
  TRY(hbvib_branch_free(branch));
  TRY(hbvib_model_free(model));
  return count == 1 && fabs(omega - 1.23202) < 1e-5 ? 0 : 1;
}
