#include "usage.h"

#include <stddef.h>
#include <string.h>

static const char overview[] =
    "usage: rhegma run CASE.yaml [options]     run a case\n"
    "       rhegma check CASE.yaml [options]   say what a run would do, without running\n"
    "       rhegma keys [PREFIX]               the keys of a case file, with units, ranges, defaults\n"
    "       rhegma materials [NAME]            solids that a case may name, with values and sources\n"
    "       rhegma material FILE.c [-o LIB.so] compile a material or law of your own for a case to load\n"
    "       rhegma mesh IN -o OUT.h5 [options] make a mesh file, or show what is in one\n"
    "       rhegma export DIR -o OUT           fields or cracks of a run as a .vtu, .vtp or .stl file\n"
    "       rhegma verify                      check the program on this machine against theory\n"
    "       rhegma --version | --help\n"
    "rhegma COMMAND --help says more of each.\n";

#define SET    "  --set a.b=value   override a value of the case file (repeatable); rhegma keys lists them\n"
#define LAYOUT "ranks: mpirun -n N rhegma ...; threads: OMP_NUM_THREADS; instruction set: RHEGMA_ISA\n"

static const struct {
    const char *command, *text;
} usages[] = {
    {"run", "usage: rhegma run CASE.yaml [options]\n"
            "       rhegma run --restart DIR [CASE.yaml] [options]\n"
            "Runs a case and writes what comes out to its output directory.\n"
            "options:\n" SET "  -o DIR            output directory (output.dir)\n"
            "  -q, --quiet       no progress\n"
            "  --restart DIR     go on with the run in DIR from its newest good checkpoint\n"
            "  --overwrite       start anew where an unfinished run left checkpoints\n"
            "  --walltime H:M:S  write a checkpoint and stop (exit status 3) before so much time has passed\n"
            "signals: USR1 writes a checkpoint; TERM, INT, HUP, USR2 write one and stop\n"
            "exit status: 0 done, 1 failed, 2 bad input, 3 stopped with a checkpoint to go on from\n" LAYOUT},
    {"check",
     "usage: rhegma check CASE.yaml [options]\n"
     "Says what a run would do: size, wave speeds, time step, steps, memory, and warnings; writes nothing.\n"
     "options:\n" SET
     "exit status: 0 a case that can run, 2 one that is wrong, with all that is wrong with it\n" LAYOUT},
    {"verify",
     "usage: rhegma verify\n"
     "Runs small cases that have an exact answer and prints theory, measured value, deviation and limit.\n"
     "exit status: 0 all hold, 1 not all\n" LAYOUT},
    {"keys",
     "usage: rhegma keys [PREFIX] [--markdown]   keys of a case file whose names begin with PREFIX, as\n"
     "                                           interface or material.young; \"expressions\": what they "
     "know\n"
     "       rhegma keys --schema                a JSON Schema of case files, for editors. To use it, begin\n"
     "                                           a case with\n"
     "                                           # yaml-language-server: $schema=PATH\n"},
    {"export",
     "usage: rhegma export DIR -o OUT.vtu [--time T]   the body with all fields, at one moment of a run\n"
     "       rhegma export DIR -o OUT.vtp|OUT.stl [--time T]   its crack surface, as it stands then\n"
     "       rhegma export DIR                 numbers and times of the moments that are there\n"
     "  --time T   the moment nearest to T (s) in place of the last one\n"
     "  --crack    the crack surface in OUT.vtu too, as triangles\n"
     "VTK, ParaView and meshio open .vtu, VTK and ParaView .vtp, with all fields; CAD programs .stl.\n"},
    {"materials",
     "usage: rhegma materials          names of solids for material.preset, one a line\n"
     "       rhegma materials NAME     its values, with cohesive ones beside them, source and validity\n"},
    {"material",
     "usage: rhegma material FILE.c [-o LIB.so] [--law] [--isa NAME]\n"
     "Compiles a material of your own into a library that a case names: material: {model: user, library: "
     "LIB.so, ...}.\n"
     "  --law        a cohesive law instead: interface: {law: user, library: LIB.so, ...}\n"
     "  -o LIB.so    the library (FILE.so)\n"
     "  --isa NAME   instruction set that it is for, as RHEGMA_ISA has it (that of this machine)\n"
     "The compiler is the one that this program was built with, or the one that CC names.\n"},
};

const char *rg_usage(const char *command) {
    for (size_t i = 0; command != NULL && i < sizeof usages / sizeof *usages; i++) {
        if (strcmp(usages[i].command, command) == 0) {
            return usages[i].text;
        }
    }
    return overview;
}
