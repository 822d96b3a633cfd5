/* Enters with files alone: in_c CASE_FOLDER RESULT. A plate in snow that remembers; other cases it declines. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static char text[100000];

/* The numbers behind a key, as many as there are. */
static int numbers(const char* key, double* out) {
  char *at = strstr(text, key), *end;
  int n = 0;
  if (at == NULL) return 0;
  for (at += strlen(key), at += strspn(at, "\": [\n"); n < 99; ++n) {
    out[n] = strtod(at, &end);
    if (end == at) return n;
    at = end + strspn(end, " \n");
    if (*at != ',') return n + 1;
    at += 1 + strspn(at + 1, " \n");
  }
  return n;
}

int main(int count, char** words) {
  char path[4000];
  double length, width, hard, ratio, depth[99], load[99], most = 0.0;
  if (count != 3 || snprintf(path, sizeof path, "%s/case.json", words[1]) >= (int)sizeof path) return 1;
  FILE *in = fopen(path, "r"), *out = fopen(words[2], "w");
  if (in == NULL || out == NULL || fread(text, 1, sizeof text - 1, in) == 0) return 1;
  char* name = strstr(text, "\"case\": \"") + 9;
  fprintf(out, "{\"openbench\": \"v1\", \"case\": \"%.*s\", ", (int)(strchr(name, '"') - name), name);
  if (strncmp(name, "01-plate", 8) != 0 || !numbers("length_m\"", &length) || !numbers("width_m\"", &width) ||
      !numbers("snow_hardness_N_per_m3\"", &hard) || !numbers("unloading_ratio_1\"", &ratio)) {
    fprintf(out, "\"declined\": \"plates alone\"}");
    return fclose(out);
  }
  double stiff = hard * length * width;
  int depths = numbers("\"depth_m\"", depth), loads = numbers("\"load_N\"", load);
  for (int i = 0; i < depths; ++i) {
    if (depth[i] > most) most = depth[i];
    double force = stiff * (most - ratio * (most - depth[i]));
    fprintf(out, "%s%.15g", i ? ", " : "\"values\": {\"force_N\": [", force > 0.0 ? force : 0.0);
  }
  for (int i = 0, largest = 0; i < loads; ++i) {
    if (load[i] > load[largest]) largest = i;
    fprintf(out, "%s%.15g", i ? ", " : "], \"depth_m\": [", (load[largest] - (load[largest] - load[i]) / ratio) / stiff);
  }
  fprintf(out, "]}}");
  return fclose(out);
}
