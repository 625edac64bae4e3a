/* Readers and writers of matrices of finite-element programs: Matrix Market (also gzipped), Abaqus
 * *MATRIX GENERATE, CalculiX matrix storage, superelements of both (*USER ELEMENT), Harwell-Boeing text, Nastran
 * OP4 (text and binary) and DMIG, NumPy and scipy (.npz), MATLAB (.mat), Ansys .full. A
 * library of its own, libhbvib_io: `cargo build --release -p hbvib-io`.
 *
 *   hbvib_io_file *file = NULL;
 *   hbvib_io_matrix k;
 *   if (hbvib_io_read("wheel.sti", &file) != 0) return puts(hbvib_io_last_error());
 *   if (hbvib_io_matrix_of(file, HBVIB_IO_STIFFNESS, &k) == 0) use(k.rows, k.row, k.column, k.values);
 *   hbvib_io_free(file);
 */
#ifndef HBVIB_IO_H
#define HBVIB_IO_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What a file holds. */
typedef struct HbvibIoFile hbvib_io_file;

/* Kinds of matrices, as hbvib_matrix_kind. */
enum { HBVIB_IO_MASS = 0, HBVIB_IO_DAMPING = 1, HBVIB_IO_STIFFNESS = 2, HBVIB_IO_STRUCTURAL = 3 };

/* Relation of an entry off the diagonal to its mirror image. */
enum {
  HBVIB_IO_GENERAL = 0,   /* all entries are listed */
  HBVIB_IO_SYMMETRIC = 1, /* the entry stands for its mirror image as well */
  HBVIB_IO_HERMITIAN = 2, /* the mirror image is the conjugate */
  HBVIB_IO_SKEW = 3       /* the mirror image has the other sign */
};

/* A sparse matrix; its arrays belong to the file. Entries at the same place add up. */
typedef struct {
  int64_t rows;
  int64_t columns;
  int64_t entries;
  int32_t is_complex;     /* values are pairs of real and imaginary part */
  int32_t symmetry;       /* HBVIB_IO_GENERAL, ... */
  const uint32_t *row;    /* from 0, entries numbers */
  const uint32_t *column; /* from 0, entries numbers */
  const double *values;   /* entries numbers, or twice as many */
} hbvib_io_matrix;

/* Reads a file. Of CalculiX, any file of a job reads all of them. A format that does not say what it
 * holds has its matrix as stiffness.
 *
 * path  ends with a zero byte.
 * out   receives the file; untouched on error. Free it by hbvib_io_free.
 * Returns 0, or -1 with a sentence of file, line and reason in hbvib_io_last_error. Threads: any. */
int32_t hbvib_io_read(const char *path, hbvib_io_file **out);

/* Reads the matrices of one model from several files; each path may be NULL. A file under the name of its
 * matrix holds that one alone, and goes before matrices. Rows are brought to one order by node and
 * direction where the files name them, and rows that one of them lacks are zero there.
 *
 * Returns and threads: as hbvib_io_read; matrices of different sizes are refused with their files. */
int32_t hbvib_io_read_files(const char *matrices, const char *stiffness, const char *mass, const char *damping,
                            const char *structural, hbvib_io_file **out);

/* A line of the report on the matrices of a file: with warnings = 0 its totals (sizes, mass along each
 * direction, supports), with 1 values that the matrices of a structure do not have. The string belongs to the
 * file. Returns NULL past the last line. */
const char *hbvib_io_report_line(const hbvib_io_file *file, int32_t warnings, int64_t index);

/* Fills out with a matrix of a file. Returns 0; 1 if the file does not hold it; -1 on error. */
int32_t hbvib_io_matrix_of(const hbvib_io_file *file, int32_t which, hbvib_io_matrix *out);

/* Number of degrees of freedom whose nodes the file names, 0 if it names none; -1 for NULL. */
int64_t hbvib_io_dofs(const hbvib_io_file *file);

/* Copies node number and direction of each degree of freedom, two numbers each; 0 is a direction that the file
 * does not name. Returns 0 or -1. */
int32_t hbvib_io_dof_table(const hbvib_io_file *file, int64_t *table);

/* Frees a file; NULL does nothing. Its matrices are gone with it. */
void hbvib_io_free(hbvib_io_file *file);

/* A file without matrices, to be set and written. Free it by hbvib_io_free. Returns 0 or -1. */
int32_t hbvib_io_new(hbvib_io_file **out);

/* Copies a matrix into a file, in place of the one that is there.
 *
 * which   HBVIB_IO_MASS, ...
 * matrix  entries within rows and columns, with finite values.
 * Returns 0, or -1 with a sentence in hbvib_io_last_error. */
int32_t hbvib_io_set_matrix(hbvib_io_file *file, int32_t which, const hbvib_io_matrix *matrix);

/* Copies node number and direction (1 to 6, or 0) of each degree of freedom, two numbers each. Returns 0 or -1. */
int32_t hbvib_io_set_dofs(hbvib_io_file *file, int64_t count, const int64_t *table);

/* Writes the matrices of a file, as they were read or set: superelements for other programs.
 *
 * path    ends with a zero byte; a file that is there is replaced.
 * format  op4, op4-binary, dmig, user-element, npz, matrix-market, or NULL: that of the name of the file. Several
 *         matrices in matrix-market are a file each, whose names end with _stiffness, _mass, ...
 * Returns 0, or -1 with a sentence, as where a format cannot hold these matrices. Threads: any. */
int32_t hbvib_io_write(const hbvib_io_file *file, const char *path, const char *format);

/* Results of nodes that are gathered for a universal file (UFF). */
typedef struct HbvibIoResults hbvib_io_results;

/* Results without any. nodes and positions (x, y, z of each) are the mesh; both may be NULL with count 0. Free them by
 * hbvib_io_results_free. Returns 0 or -1. */
int32_t hbvib_io_results_new(int64_t count, const int64_t *nodes, const double *positions, hbvib_io_results **out);

/* Adds complex motions of nodes at a frequency: values has real and imaginary part along x, y and z, 6 count numbers.
 * text is a line for the file, or NULL. Returns 0 or -1. */
int32_t hbvib_io_results_add_shape(hbvib_io_results *results, const char *text, double frequency, int64_t count,
                                   const int64_t *nodes, const double *values);

/* Adds a complex function over frequency at a node and direction, as a response: 2 count values. Returns 0 or -1. */
int32_t hbvib_io_results_add_function(hbvib_io_results *results, const char *text, int64_t node, int64_t direction,
                                      int64_t count, const double *frequencies, const double *values);

/* Writes nodes (2411), functions (58) and shapes (55) of a universal file. Returns 0, or -1 with a sentence: numbers that
 * are not finite, or the reason of the system. */
int32_t hbvib_io_results_write(const hbvib_io_results *results, const char *path);

/* Frees results; NULL does nothing. */
void hbvib_io_results_free(hbvib_io_results *results);

/* The sentence of the last error of this thread, until its next call. */
const char *hbvib_io_last_error(void);

#ifdef __cplusplus
}
#endif

#endif
