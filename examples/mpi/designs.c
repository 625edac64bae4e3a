/* A study of many designs on the processes of MPI: the highest peak of a saved model against the normal load and the
 * stiffness of its first contact.
 *
 *   mpirun -n 4 ./designs MODEL FOLDER [MOST]
 *
 * The first process reads the model (hbvib_model_save, Model.save in Python) and sends its bytes to the others. A chunk
 * of designs that is done is a file in FOLDER. A second start, on any number of processes and of this program or the one
 * in Fortran, does the chunks that are missing. With MOST a process ends after so many chunks, as a job does whose time is over.
 */
#include <hbvib.h>
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LOADS = 12, STIFFNESSES = 8, CHUNK = 8, DESIGNS = LOADS * STIFFNESSES, CHUNKS = DESIGNS / CHUNK };

/* Results of a chunk as they lie in its file; `mark` is the checksum of the model. */
typedef struct chunk {
    unsigned char mark[8];
    double amplitude[CHUNK], omega[CHUNK];
    int64_t status[CHUNK];
} chunk;

static void check(hbvib_status status, const char *call)
{
    if (status >= HBVIB_OK) return;
    fprintf(stderr, "%s: %s: %s\n", call, hbvib_status_name(status), hbvib_last_error());
    MPI_Abort(MPI_COMM_WORLD, EXIT_FAILURE);
}
#define CHECK(call) check((call), #call)

static void need(int holds, const char *what)
{
    if (holds) return;
    fprintf(stderr, "designs: %s\n", what);
    MPI_Abort(MPI_COMM_WORLD, EXIT_FAILURE);
}

/* Normal load in N and stiffness in N/m of a design. */
static void values_of(int design, double values[2])
{
    values[0] = 100.0 + 100.0 * (design / STIFFNESSES);
    values[1] = 3e7 + 1e7 * (design % STIFFNESSES);
}

static void path_of(const char *folder, int number, const char *end, char path[512])
{
    snprintf(path, 512, "%s/chunk_%03d%s", folder, number, end);
}

/* Reads a chunk; 0 where it is not done yet, or belongs to another model. */
static int done(const char *folder, int number, const unsigned char mark[8], chunk *found)
{
    char path[512];
    FILE *file;
    int whole;
    path_of(folder, number, ".bin", path);
    file = fopen(path, "rb");
    if (!file) return 0;
    whole = fread(found, sizeof *found, 1, file) == 1 && memcmp(found->mark, mark, 8) == 0;
    fclose(file);
    return whole;
}

/* Solves a chunk and writes it under its name when it is whole. */
static void solve(const hbvib_model *model, const char *folder, int number, const unsigned char mark[8])
{
    hbvib_solver_options solver;
    hbvib_batch_options options;
    hbvib_parameter parameters[2];
    hbvib_batch *batch = NULL;
    double values[CHUNK][2];
    chunk result;
    char path[512], unfinished[512];
    FILE *file;
    int i;
    for (i = 0; i < CHUNK; i++) values_of(number * CHUNK + i, values[i]);
    for (i = 0; i < 2; i++) {
        CHECK(hbvib_parameter_init(&parameters[i], sizeof parameters[i]));
        parameters[i].kind = i == 0 ? HBVIB_PARAMETER_PRELOAD : HBVIB_PARAMETER_KT;
        parameters[i].contact = 0;
    }
    CHECK(hbvib_solver_options_init(&solver, sizeof solver));
    solver.tolerance = 0;
    solver.harmonics = 9;
    solver.response_dof = 0;
    CHECK(hbvib_batch_options_init(&options, sizeof options));
    options.omega_start = 2 * 3.14159265358979323846 * 205;
    options.omega_stop = 2 * 3.14159265358979323846 * 213;
    CHECK(hbvib_batch_solve(model, &solver, &options, NULL, parameters, 2, CHUNK, &values[0][0], &batch));
    memcpy(result.mark, mark, 8);
    CHECK(hbvib_batch_peaks(batch, CHUNK, result.amplitude, result.omega, result.status, NULL));
    CHECK(hbvib_batch_free(batch));
    path_of(folder, number, ".part", unfinished);
    path_of(folder, number, ".bin", path);
    file = fopen(unfinished, "wb");
    need(file && fwrite(&result, sizeof result, 1, file) == 1, "the folder cannot be written");
    need(fclose(file) == 0 && rename(unfinished, path) == 0, "the folder cannot be written");
}

int main(int argc, char **argv)
{
    int rank, processes, missing[CHUNKS], count = 0, most, i;
    long long length = 0;
    unsigned char *bytes = NULL;
    hbvib_model *model = NULL;
    chunk found;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &processes);
    need(argc >= 3, "needs MODEL FOLDER [MOST]");
    most = argc > 3 ? atoi(argv[3]) : CHUNKS;

    if (rank == 0) {
        FILE *file = fopen(argv[1], "rb");
        need(file != NULL, "the model cannot be read");
        fseek(file, 0, SEEK_END);
        length = ftell(file);
        rewind(file);
        bytes = malloc((size_t)length);
        need(bytes && fread(bytes, 1, (size_t)length, file) == (size_t)length && length >= 8, "the model cannot be read");
        fclose(file);
    }
    MPI_Bcast(&length, 1, MPI_LONG_LONG, 0, MPI_COMM_WORLD);
    if (rank != 0) bytes = malloc((size_t)length);
    need(bytes != NULL, "no memory for the model");
    MPI_Bcast(bytes, (int)length, MPI_BYTE, 0, MPI_COMM_WORLD);
    CHECK(hbvib_model_load(length, bytes, &model));

    /* The first process looks which chunks are missing, so that all divide the same ones. */
    if (rank == 0)
        for (i = 0; i < CHUNKS; i++)
            if (!done(argv[2], i, bytes + length - 8, &found)) missing[count++] = i;
    MPI_Bcast(&count, 1, MPI_INT, 0, MPI_COMM_WORLD);
    MPI_Bcast(missing, count, MPI_INT, 0, MPI_COMM_WORLD);
    for (i = rank; i < count && most > 0; i += processes, most--) solve(model, argv[2], missing[i], bytes + length - 8);
    MPI_Barrier(MPI_COMM_WORLD);

    if (rank == 0) {
        int left = 0, k;
        for (i = 0; i < CHUNKS; i++) left += !done(argv[2], i, bytes + length - 8, &found);
        fprintf(stderr, "%d of %d chunks were missing, %d are now\n", count, CHUNKS, left);
        if (left == 0) printf("  N0/N   kt/(N/m)              f/Hz            |X1|/m  status\n");
        for (i = 0; left == 0 && i < CHUNKS; i++) {
            done(argv[2], i, bytes + length - 8, &found);
            for (k = 0; k < CHUNK; k++) {
                double values[2];
                values_of(i * CHUNK + k, values);
                printf("%6.0f  %9.2E  %16.11f  %16.9E  %6d\n", values[0], values[1], found.omega[k] / (2 * 3.14159265358979323846),
                       found.amplitude[k], (int)found.status[k]);
            }
        }
    }
    CHECK(hbvib_model_free(model));
    free(bytes);
    MPI_Finalize();
    return EXIT_SUCCESS;
}
