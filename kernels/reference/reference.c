/* The reference set, and the face quadrature that its bulk and interface kernels share. */
#include "reference/reference.h"

double rg_reference_face_point(int q, double l[3]) {
    static const double place[2] = {0.445948490915965, 0.091576213509771};
    static const double weight[2] = {0.223381589678011, 0.109951743655322};
    int orbit = q / 3;
    for (int i = 0; i < 3; i++)
        l[i] = i == q % 3 ? 1 - 2 * place[orbit] : place[orbit];
    return weight[orbit];
}

void rg_reference_face_shape(const double l[3], double n[RG_FNODES]) {
    for (int i = 0; i < 3; i++)
        n[i] = l[i] * (2 * l[i] - 1);
    n[3] = 4 * l[0] * l[1];
    n[4] = 4 * l[1] * l[2];
    n[5] = 4 * l[0] * l[2];
}

const rg_kernels rg_kernels_reference = {
    .name = "reference",
    .send = rg_reference_send,
    .send_tractions = rg_reference_send_tractions,
    .receive = rg_reference_receive,
    .bulk = rg_reference_bulk,
    .interface = rg_reference_interface,
    .kick = rg_reference_kick,
    .drift = rg_reference_drift,
    .bulk_state = rg_reference_bulk_state,
    .kinetic = rg_reference_kinetic,
    .interface_state = rg_reference_interface_state,
    .viscosity = rg_reference_viscosity,
    .contact = rg_reference_contact,
    .prestress = rg_reference_prestress,
    .prestress_state = rg_reference_prestress_state,
};
