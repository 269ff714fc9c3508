/* The registry of a library: the user's law alone (laws.h). No include guard. */
RG_LAW(USER, user, "user", "", RG_FORMS_DG, 1, 1, 0, 0, 0)
