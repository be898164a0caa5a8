/* Reads a problem with Debian's FCLIB, the library that Siconos reads files by, and prints Siconos'
   own error of its reference; then, of 0.9 times the reference's impulses, that of the problem
   without its bodies, (W, q, mu). (FCLIB reads an answer from the problem's own file only.) Nothing
   here is Ballast's.

     read_by_siconos PROBLEM.hdf5 REFERENCE */
#include <fclib.h>
#include <hdf5.h>
#include <hdf5_hl.h>
#include <math.h>
#include <siconos/numerics/FrictionContactProblem.h>
#include <siconos/numerics/GlobalFrictionContactProblem.h>
#include <siconos/numerics/NumericsMatrix.h>
#include <siconos/numerics/Friction_cst.h>
#include <siconos/numerics/SolverOptions.h>
#include <siconos/numerics/fc3d_compute_error.h>
#include <siconos/numerics/gfc3d_compute_error.h>
#include <stdio.h>
#include <stdlib.h>

/* FCLIB: nz = -1 compressed columns, -2 compressed rows, else triplets. */
static NumericsMatrix* dense(const struct fclib_matrix* a) {
  double* x = calloc((size_t)a->m * a->n, sizeof(double));
  const int lines = a->nz == -1 ? a->n : a->m;
  if (a->nz >= 0)
    for (int k = 0; k < a->nz; ++k) x[a->i[k] + (size_t)a->m * a->p[k]] += a->x[k];
  else
    for (int line = 0; line < lines; ++line)
      for (int k = a->p[line]; k < a->p[line + 1]; ++k) {
        const int row = a->nz == -1 ? a->i[k] : line, column = a->nz == -1 ? line : a->i[k];
        x[row + (size_t)a->m * column] = a->x[k];
      }
  return NM_create_from_data(NM_DENSE, a->m, a->n, x);
}

static double norm(const double* x, int n) {
  double sum = 0.0;
  for (int k = 0; k < n; ++k) sum += x[k] * x[k];
  return sqrt(sum);
}

/* W = H^T M^-1 H, q = H^T M^-1 f + w; M is diagonal. */
static double local_error(GlobalFrictionContactProblem* problem, double* r) {
  const int n = problem->H->size1, dofs = problem->H->size0;
  const double *h = problem->H->matrix0, *m = problem->M->matrix0;
  double *w = calloc((size_t)n * n, sizeof(double)), *q = calloc(n, sizeof(double)),
         *u = calloc(n, sizeof(double));
  for (int c = 0; c < n; ++c) {
    q[c] = problem->b[c];
    for (int d = 0; d < dofs; ++d) {
      const double at = h[d + (size_t)dofs * c] / m[d + (size_t)dofs * d];
      if (at == 0.0) continue;
      q[c] += at * problem->q[d];
      for (int k = 0; k < n; ++k) w[k + (size_t)n * c] += at * h[d + (size_t)dofs * k];
    }
  }
  FrictionContactProblem* local = frictionContactProblem_new_with_data(
      3, problem->numberOfContacts, NM_create_from_data(NM_DENSE, n, n, w), q, problem->mu);
  for (int c = 0; c < n; ++c) r[c] *= 0.9;
  double error = NAN;
  fc3d_compute_error(local, r, u, 1e-6, solver_options_create(SICONOS_FRICTION_3D_NSGS),
                     norm(q, n), &error);
  return error;
}

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  struct fclib_global* read = fclib_read_global(argv[1]);
  const hid_t answer = H5Fopen(argv[2], H5F_ACC_RDONLY, H5P_DEFAULT);
  if (!read || answer < 0) return 1;
  double *r = calloc(read->H->n, sizeof(double)), *u = calloc(read->H->n, sizeof(double)),
         *v = calloc(read->H->m, sizeof(double));
  H5LTread_dataset_double(answer, "/solution/r", r);
  H5LTread_dataset_double(answer, "/solution/v", v);
  GlobalFrictionContactProblem* problem = globalFrictionContactProblem_new();
  problem->dimension = read->spacedim;
  problem->numberOfContacts = read->H->n / read->spacedim;
  problem->M = dense(read->M);
  problem->H = dense(read->H);
  problem->q = read->f;
  problem->b = read->w;
  problem->mu = read->mu;
  SolverOptions* options = solver_options_create(SICONOS_GLOBAL_FRICTION_3D_NSGS);
  double error = NAN;
  gfc3d_compute_error(problem, r, u, v, 1e-6, options, norm(read->f, read->M->m),
                      norm(read->w, read->H->n), &error);
  printf("contacts %d error %.3e\n", problem->numberOfContacts, error);
  printf("%.9e\n", local_error(problem, r));
  return error < 1e-6 ? 0 : 1;
}
