SwaggerUIBundle({
  url: "openapi.json",
  dom_id: "#swagger-ui",
  deepLinking: true,
  displayRequestDuration: true,
  // The models are shown with the requests that use them.
  defaultModelsExpandDepth: -1,
  // Swagger UI would send the document to a validator on another host.
  validatorUrl: null,
});
