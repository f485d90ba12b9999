/* What core and the module libnacre_oiio.so agree on: plain C, so that neither's compiler or library matters to the
   other. The caller sets the limits; the module fills the rest. Not part of the interface. */
#pragma once

#ifdef __cplusplus
extern "C" {
#endif

struct NacreOiioImage {
    int codes;            /* wanted: integers as they are, alpha not multiplied in */
    int max_edge;         /* largest edge accepted [texels] */
    long long max_values; /* texels times channels */
    int width, height, channels;
    float* values;          /* integers as code / largest code, or codes; freed by nacre_oiio_free */
    int is_integer;         /* the file holds integers */
    char sample_type[32];   /* uint8, half, … */
    char format[32];        /* the reader's name */
    char color_space[64];   /* as the file states it, or empty */
    char message[512];      /* why it failed */
};

/* 0 = done. */
typedef int (*NacreOiioRead)(const char* path, struct NacreOiioImage* image);
typedef void (*NacreOiioFree)(struct NacreOiioImage* image);

#ifdef __cplusplus
}
#endif
