// One call of every endpoint that computes, with the types of openapi-typescript: no any, no casts.
import createClient from "openapi-fetch";
import type { paths, components } from "./api.js";

declare const process: { argv: string[]; exit(code: number): never };

type Schemas = components["schemas"];
const client = createClient<paths, "application/json">({ baseUrl: process.argv[2] });
const profile: Schemas["ParaboloidProfile"] = { kind: "paraboloid", radius: 0.01 };
const material: Schemas["Moduli"] = { e_star: 1.15e11, g_star: 9.5e10 };
const contact = { profile, material, load: { normal_force: 10 } };
const friction = { ...contact, friction_coefficient: 0.3 };
const sheared = { ...friction, tangential: { tangential_force: 2 } };
const worn = { ...friction, oscillation: { tangential_force: 2 } };

const depth = (await client.POST("/v1/normal", { body: contact })).data?.indentation_depth[0];
const stick = (await client.POST("/v1/tangential", { body: sheared })).data?.stick_radius[0];
const cycles = { normal: { normal_force: 10 }, tangential: { tangential_force: 2 } };
const history = { profile, material, friction_coefficient: 0.3, cycles };
const energy = (await client.POST("/v1/tangential/history", { body: history })).data
  ?.energy_per_cycle?.[0];
const stress = { ...sheared, radius: [0], quantities: ["pressure" as const] };
const pressure = (await client.POST("/v1/stress", { body: stress })).data?.pressure?.[0]?.[0];
const beneath = {
  ...contact,
  material: { e_star: 1.15e11, poissons_ratio: 0.3 },
  x: [0],
  z: [4e-5],
};
const mises = (await client.POST("/v1/subsurface", { body: beneath })).data?.von_mises?.[0]?.[0]?.[0];
const limit = (await client.POST("/v1/wear", { body: worn })).data?.wear_radius[0];
const evolution = { ...worn, wear_coefficient: 1e-14, cycles: [1e5] };
const volume = (await client.POST("/v1/wear/evolution", { body: evolution })).data?.worn_volume[0];
const batch = { queries: [{ ask: "normal" as const, request: contact }] };
const status = (await client.POST("/v1/batch", { body: batch })).data?.answers[0]?.status;
const kinds = (await client.GET("/v1/profiles")).data?.profiles.length;

const found: Record<string, number | null | undefined> = {
  depth, stick, energy, pressure, mises, limit, volume, status, kinds,
};
console.log(JSON.stringify(found));
